// Keeps the page in the browser, so that it opens without a network. The folder of scripts has the hash of their content as its name, so that
// a new document of the network brings new scripts, and a kept one the kept scripts. A new version is kept beside the old one until no page of the
// old one is open.

/** All files of this version but its document, and its hash: `cargo xtask page` fills them in. */
declare const FILES: string[];
declare const VERSION: string;

const worker = self as unknown as ServiceWorkerGlobalScope;
const { scope } = worker.registration;
const OWN = `hovertone ${scope} `;
const DOCUMENT = "./";
/** Wait for a network that is there and does not answer. */
const NETWORK_MS = 3000;

worker.addEventListener("install", (event) => event.waitUntil(keep()));
worker.addEventListener("activate", (event) => event.waitUntil(forgetOthers()));
worker.addEventListener("fetch", (event) => {
  const { request } = event;
  if (request.method !== "GET" || !request.url.startsWith(scope)) return;
  event.respondWith(request.mode === "navigate" ? newest(request) : kept(request));
});

async function keep() {
  const cache = await caches.open(OWN + VERSION);
  await cache.addAll([DOCUMENT, ...FILES].map((file) => new Request(file, { cache: "no-cache" })));
}

async function forgetOthers() {
  const names = await caches.keys();
  await Promise.all(names.filter((name) => name.startsWith(OWN) && name !== OWN + VERSION).map((name) => caches.delete(name)));
}

/** The document of the network, or the kept one. */
async function newest(request: Request): Promise<Response> {
  const held = await (await caches.open(OWN + VERSION)).match(DOCUMENT);
  const ofNetwork = fetch(request.url, { cache: "no-cache", redirect: "manual" });
  if (!held) return ofNetwork;
  const late = new Promise<Response>((resolve) => setTimeout(() => resolve(held), NETWORK_MS));
  return Promise.race([ofNetwork.catch(() => held), late]);
}

async function kept(request: Request): Promise<Response> {
  const held = await (await caches.open(OWN + VERSION)).match(request, { ignoreSearch: true });
  return held ?? fetch(request);
}
