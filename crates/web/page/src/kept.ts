// Trials of the microphone, kept in the browser: their sound, their answers, and the experiment that they belong to.

import type { Answer, Entries } from "./answers";

const SOUNDS = "sounds";
const ANSWERS = "answers";
const STATE = "state";
const ENTRIES = "entries";

export interface KeptTrial {
  name: string;
  bytes: Uint8Array<ArrayBuffer>;
  answer?: Answer;
}

let database: Promise<IDBDatabase> | undefined;

function opened(): Promise<IDBDatabase> {
  if (database) return database;
  const request = indexedDB.open("hovertone", 1);
  request.onupgradeneeded = () => [SOUNDS, ANSWERS, STATE].forEach((name) => request.result.createObjectStore(name));
  return (database = done(request));
}

function done<T>(request: IDBRequest<T>): Promise<T> {
  return new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });
}

async function write(names: string[], work: (store: (name: string) => IDBObjectStore) => void): Promise<void> {
  const transaction = (await opened()).transaction(names, "readwrite", { durability: "strict" });
  work((name) => transaction.objectStore(name));
  return new Promise((resolve, reject) => {
    transaction.oncomplete = () => resolve();
    transaction.onabort = () => reject(transaction.error);
  });
}

/** Keeps a trial and the experiment that it belongs to, both or none. */
export function keepTrial({ name, bytes }: KeptTrial, entries: Entries): Promise<void> {
  return write([SOUNDS, STATE], (store) => {
    store(SOUNDS).put(bytes, name);
    store(STATE).put(entries, ENTRIES);
  });
}

export function keepAnswer(name: string, answer: Answer): Promise<void> {
  return write([ANSWERS], (store) => void store(ANSWERS).put(answer, name));
}

export function keepEntries(entries: Entries): Promise<void> {
  return write([STATE], (store) => void store(STATE).put(entries, ENTRIES));
}

export function forgetTrial(name: string): Promise<void> {
  return write([SOUNDS, ANSWERS], (store) => [SOUNDS, ANSWERS].forEach((each) => store(each).delete(name)));
}

/** All that is kept; nothing where the browser keeps nothing. */
export async function keptTrials(): Promise<{ trials: KeptTrial[]; entries?: Entries }> {
  const transaction = (await opened()).transaction([SOUNDS, ANSWERS, STATE]);
  const [sounds, answers, state] = [SOUNDS, ANSWERS, STATE].map((name) => transaction.objectStore(name));
  const [names, bytes, heard, of, entries] = await Promise.all([
    done(sounds.getAllKeys()), done(sounds.getAll()), done(answers.getAllKeys()), done(answers.getAll()), done(state.get(ENTRIES)),
  ]);
  const answerOf = (name: IDBValidKey) => of[heard.indexOf(name)] as Answer | undefined;
  return { trials: names.map((name, index) => ({ name: String(name), bytes: bytes[index], answer: answerOf(name) })), entries };
}
