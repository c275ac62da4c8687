import { render } from "preact";
import { App } from "./app";
import { Store } from "./store";
import "./style.css";

// where the browser allows it, the page opens without a network from the second visit on
void navigator.serviceWorker?.register(new URL("service_worker.js", document.baseURI)).catch(() => {});

const root = document.getElementById("page")!;
root.replaceChildren();
render(<App store={new Store()} />, root);
