// Runs in the panel before the page of `tabray watch`, and asks the extension what the page asks its server.
"use strict";
(() => {
    const editor = acquireVsCodeApi();
    const waiting = new Map();
    let last = 0;

    window.fetch = (path, { method, body, signal } = {}) => new Promise((done, fail) => {
        const id = ++last;
        waiting.set(id, { done, fail });
        signal?.addEventListener("abort", () => {
            editor.postMessage({ id, abort: true });
            waiting.delete(id);
            fail(new DOMException("", "AbortError"));
        });
        editor.postMessage({ id, path, method, body });
    });

    window.EventSource = class extends EventTarget {
        static CLOSED = 2;
        readyState = 1;

        constructor(path) {
            super();
            waiting.set(++last, { source: this });
            editor.postMessage({ id: last, path, events: true });
        }
    };

    window.addEventListener("message", ({ data }) => {
        const { id, status, bytes, event, lost } = data;
        const { done, fail, source } = waiting.get(id) ?? {};
        if (event) return source?.dispatchEvent(new MessageEvent(event, { data: data.data }));
        waiting.delete(id);
        if (source) {
            source.readyState = 2;
            source.onerror?.();
        } else if (lost) fail?.(new TypeError("the program does not answer"));
        else done?.(new Response(bytes, { status }));
    });
})();
