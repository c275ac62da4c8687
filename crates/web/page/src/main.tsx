import { render } from "preact";
import { App } from "./app";
import { Store } from "./store";
import "./style.css";

const root = document.getElementById("page")!;
root.replaceChildren();
render(<App store={new Store()} />, root);
