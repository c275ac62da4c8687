// The constant, its verdict, and the files to keep.

import { useMemo, useState } from "preact/hooks";
import type { Identified, Table } from "./answers";
import { save } from "./save";
import { Cancelled } from "./requests";
import type { Store } from "./store";

const VERDICTS = { holds: "the loads agree", fails: "a load does not fit", untested: "not tested" };

export function Result({ store }: { store: Store }) {
  const { fit } = store;
  if (fit.state === "none") return null;
  return (
    <section class="card result" aria-label="Result" aria-busy={fit.state === "running"}>
      <h2>Thrust constant</h2>
      {fit.state === "running" && (
        <p class="working" role="status">
          the loads are heard and fitted … <progress value={fit.share} aria-label="Progress of the fit" />
          <button type="button" onClick={() => store.fitting.cancel()}>Cancel</button>
        </p>
      )}
      {fit.fault && <p class="fault" role="alert">{fit.fault}</p>}
      {fit.result && <Constant store={store} result={fit.result} isOld={fit.state !== "done"} />}
    </section>
  );
}

/** The line of the constant: the verdict stands above it where the constant must not be used. */
function constantLine(quote: string): string {
  return quote.split("\n").find((line) => /^(do not use this constant: )?C_f\b/.test(line)) ?? quote;
}

/** The constant for one rotor and for the vehicle, as they are quoted. */
export function Quoted({ quote }: { quote: string }) {
  const values = constantLine(quote).split("; ")[0].replace(/^.*C_f = /, "").split(", ");
  return (
    <p class="constant" data-quote={quote}>
      {values.map((value) => {
        const [, number, whose] = /^(\(.*?\) \S+ N s²)(.*)$/.exec(value) ?? [undefined, value, ""];
        return <span key={value}><strong>{withPowers(number)}</strong> <span class="quiet">{whose}</span></span>;
      })}
    </p>
  );
}

function Constant({ store, result, isOld }: { store: Store; result: Identified; isOld: boolean }) {
  const quote = constantLine(result.quote);
  const verdict = result.quote.split("\n").find((line) => line.startsWith("verdict: "));
  const others = result.quote.trim().split("\n").filter((line) => line !== quote && line !== verdict);
  const share = quote.split("; ")[1];
  return (
    <div class={isOld ? "old" : ""}>
      <Quoted quote={result.quote} />
      {quote.startsWith("do not use") && <p class="fault">Do not use this constant: the warnings say why.</p>}
      {share && <p>{share}</p>}
      <p class={`verdict ${result.holds ?? ""}`}>
        {result.holds && <span class="badge">{VERDICTS[result.holds]}</span>} {verdict?.replace(/^verdict: /, "")}
      </p>
      {others.map((line) => <p class="quiet" key={line}>{line}</p>)}
      <p class="quiet">{result.headline}</p>
      {result.warnings.length > 0 && (
        <details>
          <summary>{result.warnings.length === 1 ? "1 warning about the constant" : `${result.warnings.length} warnings about the constant`}</summary>
          <ul>{result.warnings.map((notice) => <li key={notice.text}>{notice.text} <span class="quiet">{notice.hint}</span></li>)}</ul>
        </details>
      )}
      <Figure svg={result.fit_svg} words="Force over the square of the speed, with the law that fits" />
      {result.loads && <DataTable table={result.loads} words="Loads" />}
      {result.budget && (
        <details>
          <summary>Uncertainty budget</summary>
          <Figure svg={result.budget_svg} words="Contributions to the uncertainty" />
          <DataTable table={result.budget} words="Uncertainty budget" />
        </details>
      )}
      {result.units.length > 0 && (
        <details>
          <summary>In units of other programs</summary>
          <table>
            <tbody>{result.units.map((unit) => <tr key={unit.unit}><th scope="row">{unit.unit}</th><td>{unit.text}</td><td><code>{unit.pasted}</code></td></tr>)}</tbody>
          </table>
        </details>
      )}
      <Files store={store} result={result} />
    </div>
  );
}

function Files({ store, result }: { store: Store; result: Identified }) {
  const [chosen, setChosen] = useState(0);
  const lines = result.simulators[chosen];
  const report = async () => {
    try {
      save("report.html", await store.fitting.report(), "text/html");
    } catch (error) {
      if (!(error instanceof Cancelled)) store.fail(error);
    }
  };
  return (
    <div class="files">
      <h3>Keep it</h3>
      <p class="group">
        <button type="button" class="main" disabled={store.busy !== undefined} onClick={() => void report()}>report.html</button>
        <button type="button" onClick={() => save("results.json", result.results, "application/json")}>results.json</button>
        <button type="button" onClick={() => void store.fitting.experimentText().then((text) => save("experiment.toml", text), (error) => store.fail(error))}>experiment.toml</button>
      </p>
      {lines && (
        <details>
          <summary>Lines for a simulator</summary>
          <p>
            <select aria-label="Simulator" value={chosen} onChange={(event) => setChosen(Number(event.currentTarget.value))}>
              {result.simulators.map((each, index) => <option value={index} key={each.name}>{each.name}</option>)}
            </select>{" "}
            <button type="button" onClick={() => void navigator.clipboard.writeText(lines.text).catch(() => {})}>Copy</button>{" "}
            <button type="button" onClick={() => save(`${lines.name}.txt`, lines.text)}>Save</button>
          </p>
          <pre tabIndex={0}>{lines.text}</pre>
        </details>
      )}
    </div>
  );
}

/** A figure as a picture of its own: its style stays inside of it. */
function Figure({ svg, words }: { svg: string | null; words: string }) {
  const source = useMemo(() => svg && `data:image/svg+xml,${encodeURIComponent(svg)}`, [svg]);
  return source ? <div class="scroll" tabIndex={0} role="region" aria-label={words}><img class="figure" src={source} alt={words} /></div> : null;
}

function DataTable({ table, words }: { table: Table; words: string }) {
  return (
    <div class="scroll" tabIndex={0} role="region" aria-label={words}>
      <table>
        <thead>
          <tr>{table.heads.map((head, index) => <th scope="col" key={index} class={head.is_number ? "number" : ""}>{head.title}{head.unit && <span class="unit">{withPowers(head.unit)}</span>}</th>)}</tr>
        </thead>
        <tbody>
          {table.rows.map((row, index) => (
            <tr key={index}>
              {row.map((cell, column) => (
                <td key={column} class={table.heads[column]?.is_number ? "number" : ""} colSpan={row.length === 2 && column === 1 ? table.heads.length - 1 : 1}>{cell}</td>
              ))}
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

/** "1e-6 N s²" with a power that people read. */
function withPowers(text: string) {
  const found = /^(.*?)1e(-?\d+)(.*)$/.exec(text);
  if (!found) return text;
  const [, before, exponent, after] = found;
  return <>{before.trim() ? `${before.trim()} · ` : ""}10<sup>{exponent.replace("-", "−")}</sup>{after}</>;
}
