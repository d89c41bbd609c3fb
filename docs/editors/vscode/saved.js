// A panel with the page of `tabray watch`. The panel cannot reach the server, which lets in only its own page: what the page
// asks goes through the extension.

const { spawn } = require("node:child_process");
const fs = require("node:fs");
const http = require("node:http");
const path = require("node:path");
const { window } = require("vscode");
const { guarded } = require("./page");

const POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:";

exports.watch = function (panel, scene, program) {
    // Without a shell, so that no file name can be a command.
    const running = spawn(program, ["watch", "--color", "never", "--", scene], { stdio: ["ignore", "ignore", "pipe"] });
    const asked = new Map();
    let said = "", server = null, isOver = false;
    const fail = (reason) => {
        if (!isOver) window.showErrorMessage(`tabray: ${reason}`);
    };
    running.on("error", (error) => fail(error.message));
    running.on("close", () => fail(`\`tabray watch\` has ended: ${said.trim()}`));
    // An editor that ends disposes of no panel.
    const end = () => running.kill();
    process.on("exit", end);
    running.stderr.setEncoding("utf8").on("data", (more) => {
        said = (said + more).slice(-4000);
        const found = !server && said.match(/ at (http:\/\/\S+)\/\?token=(\w+)/);
        if (!found) return;
        server = { origin: found[1], token: found[2] };
        said = "";
        ask("/", {}, async (answer) => {
            const bridge = fs.readFileSync(path.join(__dirname, "bridge.js"), "utf8");
            panel.webview.html = guarded((await bytesOf(answer)).toString(), POLICY, bridge);
        }).on("error", (error) => fail(error.message));
    });

    // Asks the server; the page's own query has no meaning there.
    function ask(name, { method = "GET", body } = {}, take) {
        const url = new URL(`${name.split("?")[0]}?token=${server.token}`, `${server.origin}/`);
        return http.request(url, { method, headers: { origin: server.origin } }, take).end(body ?? undefined);
    }

    const heard = panel.webview.onDidReceiveMessage((message) => {
        const { id, path: name, abort, events } = message;
        if (abort) return asked.get(id)?.destroy();
        const lost = () => panel.webview.postMessage({ id, lost: true });
        const request = ask(name, message, async (answer) => {
            if (events) return tell(answer, (event) => panel.webview.postMessage({ id, ...event })).then(lost, lost);
            const bytes = await bytesOf(answer).catch(() => null);
            if (!bytes) return lost();
            return panel.webview.postMessage({ id, status: answer.statusCode, bytes: new Uint8Array(bytes) });
        });
        asked.set(id, request);
        request.on("error", lost).on("close", () => asked.delete(id));
    });
    return {
        dispose() {
            isOver = true;
            heard.dispose();
            process.off("exit", end);
            end();
        },
    };
};

async function bytesOf(answer) {
    const parts = [];
    for await (const part of answer) parts.push(part);
    return Buffer.concat(parts);
}

// Reads server-sent events.
async function tell(answer, take) {
    let text = "";
    for await (const part of answer.setEncoding("utf8")) {
        const all = (text + part).split("\n\n");
        text = all.pop();
        for (const one of all) {
            const [, event, data] = one.match(/^event: (.*)\ndata: (.*)$/) ?? [];
            if (event) take({ event, data });
        }
    }
}
