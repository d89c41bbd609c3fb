// Keeps the page for use without a network. The version in the cache's name depends on the files' contents.
'use strict'
const NAME = 'tabray-VERSION', FILES = ['./', 'tabray.wasm', 'icon.svg', 'tabray.webmanifest']

addEventListener('install', (event) => event.waitUntil(caches.open(NAME).then((cache) => cache.addAll(FILES)).then(() => skipWaiting())))
addEventListener('activate', (event) => event.waitUntil((async () => {
  const old = (await caches.keys()).filter((name) => name.startsWith('tabray-') && name !== NAME)
  await Promise.all(old.map((name) => caches.delete(name)))
  await clients.claim()
})()))
addEventListener('fetch', (event) => {
  const { request } = event
  if (request.method !== 'GET' || new URL(request.url).origin !== location.origin) return
  event.respondWith((async () => {
    const kept = await caches.match(request, { ignoreSearch: true, cacheName: NAME })
    return kept ?? (request.mode === 'navigate' && await caches.match('./', { cacheName: NAME })) ?? fetch(request)
  })())
})
