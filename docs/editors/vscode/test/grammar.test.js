// The grammar that `tabray grammar` prints, read by the engine of Visual Studio Code.

const assert = require("node:assert");
const { execFileSync } = require("node:child_process");
const fs = require("node:fs");
const path = require("node:path");
const { test, before } = require("node:test");
const oniguruma = require("vscode-oniguruma");
const { Registry, parseRawGrammar, INITIAL } = require("vscode-textmate");
const { program, scenes } = require("./program");

let grammar;

before(async () => {
    const wasm = fs.readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm"));
    await oniguruma.loadWASM(wasm);
    const registry = new Registry({
        onigLib: Promise.resolve({
            createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
            createOnigString: (text) => new oniguruma.OnigString(text),
        }),
        loadGrammar: async () => parseRawGrammar(execFileSync(program, ["grammar"], { encoding: "utf8" }), "tabray.json"),
    });
    grammar = await registry.loadGrammar("source.tabray");
});

// Returns the words of a text, each with its innermost scope.
function words(text) {
    const found = [];
    let state = INITIAL;
    for (const line of text.split("\n")) {
        const { tokens, ruleStack } = grammar.tokenizeLine(line, state);
        state = ruleStack;
        for (const { startIndex, endIndex, scopes } of tokens) {
            const word = line.slice(startIndex, endIndex).trim();
            if (word) found.push([word, scopes.at(-1).replace(/\.tabray$/, "")]);
        }
    }
    return found;
}

function files(folder) {
    return fs.readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
        const file = path.join(folder, entry.name);
        return entry.isDirectory() ? files(file) : file.endsWith(".ray") ? [file] : [];
    });
}

// Words of scenes/language/repeat.ray, and what each is.
const EXPECTED = [
    ["camera", "storage.type"],
    ["eye", "entity.name.type"],
    ["pixeldim", "support.type.property-name"],
    ["160", "constant.numeric"],
    ["-4", "constant.numeric"],
    ["light", "storage.type"],
    ["lamp", "entity.name.type"],
    ["repeat", "keyword.control"],
    ["let", "keyword.control"],
    ["bead", "entity.name.type"],
    ['"4 + 2*cos(turn)"', "string.quoted.double"],
];

test("the words of a scene have the scopes of what they are", () => {
    const text = fs.readFileSync(path.join(scenes, "language/repeat.ray"), "utf8");
    const scopes = new Map(words(text));
    for (const [word, scope] of EXPECTED) {
        assert.strictEqual(scopes.get(word), scope, word);
    }
});

test("in scenes without errors each type and each number has its scope", () => {
    const { entities } = JSON.parse(execFileSync(program, ["list", "--json"], { encoding: "utf8" }));
    const types = new Set(entities.flatMap((entity) => [entity.name, ...entity.aliases]));
    let count = 0;
    for (const folder of ["gallery", "notes", "sphere", "light"]) {
        for (const file of files(path.join(scenes, folder))) {
            const text = fs.readFileSync(file, "utf8");
            // An entity begins a line, is followed by a name without quotes, and opens its brace on the same line.
            const begun = text.split("\n").map((line) => /^\s*(\w+)\s+[\w-]+\s*\{/.exec(line)?.[1]).filter((word) => types.has(word));
            const marked = words(text).filter(([, scope]) => scope === "storage.type").map(([word]) => word);
            for (const type of new Set(begun)) {
                const want = begun.filter((word) => word === type).length;
                assert.ok(marked.filter((word) => word === type).length >= want, `${file}: ${type}`);
            }
            for (const [word, scope] of words(text)) {
                if (/^-?\d+(\.\d+)?$/.test(word) && scope !== "entity.name.type" && !scope.startsWith("comment") && !scope.startsWith("string")) {
                    assert.strictEqual(scope, "constant.numeric", `${file}: ${word}`);
                }
            }
            count += begun.length;
        }
    }
    assert.ok(count > 50, `${count} entities`);
});
