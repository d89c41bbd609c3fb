// A session of editing with `tabray lsp`, by the protocol's own client library, without a window. `node --test` prints the
// transcript with the time of each answer.

const assert = require("node:assert");
const { spawn } = require("node:child_process");
const { test } = require("node:test");
const rpc = require("vscode-jsonrpc/node");
const { program } = require("./program");

const uri = "file:///tmp/session.ray";
const TEXT = `camera eye { pixeldim 64 48  worlddim 8 6  viewpoint 4 3 6 }
material red { ambient 1 0 0 }
sphere ball { material red   center 4 3 -4 raduis 2 }
sphere moon { material red  center 1 1 -4  radius 0.5 }
`;

test("an editor has answers while a scene is written", async () => {
    const server = spawn(program, ["lsp"], { stdio: ["pipe", "pipe", "inherit"] });
    const ended = new Promise((resolve) => server.on("exit", resolve));
    const connection = rpc.createMessageConnection(
        new rpc.StreamMessageReader(server.stdout),
        new rpc.StreamMessageWriter(server.stdin),
    );
    const waiting = [];
    connection.onNotification("textDocument/publishDiagnostics", (told) => waiting.shift()?.(told.diagnostics));
    connection.listen();
    const faults = () => timed("diagnostics", new Promise((resolve) => waiting.push(resolve)));
    async function timed(what, answer) {
        const start = performance.now();
        const result = await answer;
        console.log(`${what.padEnd(14)} ${(performance.now() - start).toFixed(1).padStart(6)} ms  ${JSON.stringify(result).slice(0, 160)}`);
        return result;
    }
    const ask = (method, more) =>
        timed(method, connection.sendRequest(`textDocument/${method}`, { textDocument: { uri }, ...more }));
    const at = (line, character) => ({ position: { line, character } });

    const { capabilities } = await timed(
        "initialize",
        connection.sendRequest("initialize", { processId: null, rootUri: null, capabilities: {} }),
    );
    await connection.sendNotification("initialized", {});

    let told = faults();
    await connection.sendNotification("textDocument/didOpen", {
        textDocument: { uri, languageId: "tabray", version: 1, text: TEXT },
    });
    const [fault] = await told;
    assert.match(fault.message, /raduis/);
    assert.deepStrictEqual(fault.range, { start: { line: 2, character: 43 }, end: { line: 2, character: 49 } });

    const [action] = await ask("codeAction", { range: fault.range, context: { diagnostics: [fault] } });
    const [edit] = action.edit.changes[uri];
    assert.strictEqual(edit.newText, "radius");
    told = faults();
    await connection.sendNotification("textDocument/didChange", {
        textDocument: { uri, version: 2 },
        contentChanges: [{ range: edit.range, text: edit.newText }],
    });
    assert.deepStrictEqual(await told, []);

    const names = (await ask("completion", at(2, 25))).map((item) => item.label);
    assert.deepStrictEqual(names, ["red"]);
    const { data } = await ask("semanticTokens/full");
    const kinds = capabilities.semanticTokensProvider.legend.tokenTypes;
    assert.deepStrictEqual([0, 1, 2, 3].map((word) => kinds[data[5 * word + 3]]), ["type", "variable", "property", "number"]);
    const hover = await ask("hover", at(2, 45));
    assert.match(hover.contents.value, /\*\*radius\*\* of sphere/);
    const renamed = await ask("rename", { ...at(1, 10), newName: "crimson" });
    assert.strictEqual(renamed.changes[uri].length, 3);
    const outline = await ask("documentSymbol", {});
    assert.deepStrictEqual(outline.map((entry) => entry.name), ["eye", "red", "ball", "moon"]);
    const formatted = await ask("formatting", { options: { tabSize: 4, insertSpaces: true } });
    assert.match(formatted[0].newText, /sphere   ball \{ material red  center 4 3 -4  radius 2 \}/);

    await timed("shutdown", connection.sendRequest("shutdown"));
    await connection.sendNotification("exit");
    assert.strictEqual(await ended, 0);
});
