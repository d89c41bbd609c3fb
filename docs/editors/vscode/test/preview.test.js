// The panels beside a scene, without a window: what they are told, and what they write.

const assert = require("node:assert");
const { execFileSync } = require("node:child_process");
const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");
const { test, before, after } = require("node:test");
const { state, Uri } = require("./vscode");
const { show } = require("../preview");
const { program } = require("./program");

const SCENE = `camera eye { pixeldim 8 6  worlddim 8 6  viewpoint 4 3 6 }
material red { ambient 1 0 0 }
sphere ball { material red  center 4 3 -4  radius 2 }
`;

let folder;
before(() => { folder = fs.mkdtempSync(path.join(os.tmpdir(), "tabray-")); });
after(() => fs.rmSync(folder, { recursive: true }));

async function until(condition) {
    for (const end = Date.now() + 60000; !condition(); ) {
        assert.ok(Date.now() < end, `waited for ${condition}: ${state.errors}`);
        await new Promise((done) => setTimeout(done, 10));
    }
}

test("what is typed is shown, and what the page changes is written", async () => {
    fs.writeFileSync(path.join(folder, "tabray.html"), '<!doctype html>\n<meta charset="utf-8">\n<script>page()</script>\n');
    fs.writeFileSync(path.join(folder, "wood.png"), "wood");
    const scene = state.open(new Uri(path.join(folder, "scene.ray")), "radius 2\r\nangle 3\r\n");
    const panel = show(scene, folder, "no program");
    assert.strictEqual(show(scene, folder, "no program"), undefined, "there is one already");
    assert.match(panel.webview.html, /Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval'/);
    assert.deepStrictEqual(panel.sent, []);
    await panel.heard.tell({ ready: true });
    assert.deepStrictEqual(panel.sent, [{ text: "radius 2\nangle 3\n" }]);

    await panel.heard.tell({ text: "radius 2.5\nangle 3\n", before: "radius 2\nangle 3\n" });
    const [{ range, text }] = state.edits;
    assert.deepStrictEqual([range.start, range.end, text].map((one) => one.character ?? one), [8, 8, ".5"]);
    scene.text = "radius 7\n";
    await state.changed.tell({ document: scene });
    await panel.heard.tell({ text: "radius 3\n", before: "radius 2\n" });
    assert.strictEqual(scene.text, "radius 7\n", "what is typed holds");
    await until(() => panel.sent.at(-1).text === "radius 7\n");

    await panel.heard.tell({ lacks: ["wood.png", "no.png"] });
    const [{ name, bytes }] = panel.sent.at(-1).files;
    assert.deepStrictEqual([name, Buffer.from(bytes).toString(), panel.sent.at(-1).files.length], ["wood.png", "wood", 1]);
    fs.writeFileSync(path.join(folder, "wood.png"), "oak");
    await state.saved.tell({ uri: Uri.joinPath(scene.uri, "..", "wood.png") });
    await until(() => Buffer.from(panel.sent.at(-1).files[0].bytes).toString() === "oak");
    await panel.dispose();
    assert.deepStrictEqual([state.changed.count(), state.saved.count()], [0, 0]);
    assert.deepStrictEqual(state.errors, []);
});

test("a panel is the page of a watch of its own, which it asks through the extension", async () => {
    state.settings.preview = "saved";
    const file = path.join(folder, "a scene.ray");
    fs.writeFileSync(file, SCENE);
    const panel = show(state.open(new Uri(file), SCENE), folder, program);
    await until(() => panel.webview.html);
    const { html } = panel.webview;
    assert.ok(html.indexOf("acquireVsCodeApi()") < html.indexOf("const follow"), "the bridge comes first");
    assert.match(html, /Content-Security-Policy/);

    const events = () => panel.sent.filter(({ id }) => id === 1);
    await panel.heard.tell({ id: 1, path: "events?id=panel", events: true });
    await until(() => events().some(({ event }) => event === "done"));
    const { name, text } = JSON.parse(events().find(({ event }) => event === "scene").data);
    assert.deepStrictEqual([path.basename(name), text], ["a scene.ray", SCENE]);

    const ask = async (id, message) => {
        await panel.heard.tell({ id, ...message });
        await until(() => panel.sent.some((sent) => sent.id === id));
        const { status, bytes } = panel.sent.find((sent) => sent.id === id);
        return [status, Buffer.from(bytes).toString()];
    };
    assert.match((await ask(2, { path: "plan/1" }))[1], /mirrors/);
    assert.strictEqual((await ask(3, { path: "no such page" }))[0], 404);
    const body = JSON.stringify({ name: "ball", attribute: "radius", values: ["1.5"] });
    assert.deepStrictEqual(await ask(4, { path: "try", method: "POST", body }), [200, "tried\n"]);
    await until(() => events().filter(({ event }) => event === "done").length === 2);
    assert.deepStrictEqual(await ask(5, { path: "write", method: "POST", body: "" }), [200, "written\n"]);
    assert.strictEqual(fs.readFileSync(file, "utf8"), SCENE.replace("radius 2", "radius 1.5"));

    await panel.dispose();
    await until(() => events().at(-1).lost);
    assert.deepStrictEqual(state.errors, []);
});

test("a watch ends with the editor", async () => {
    const file = path.join(folder, "left.ray");
    fs.writeFileSync(file, SCENE);
    const session = `
        const process_ = require("node:child_process"), { spawn } = process_;
        process_.spawn = (...how) => { const child = spawn(...how); console.log(child.pid); return child; };
        const { state, Uri } = require("./vscode");
        state.settings.preview = "saved";
        const panel = require("../preview").show(state.open(new Uri(${JSON.stringify(file)}), ""), "", ${JSON.stringify(program)});
        setInterval(() => { if (panel.webview.html) process.exit(0); }, 10);`;
    const pid = +execFileSync(process.execPath, ["-e", session], { cwd: __dirname, encoding: "utf8", timeout: 60000 });
    const runs = () => {
        try {
            // One that has ended may wait for its parent.
            return !fs.readFileSync(`/proc/${pid}/stat`, "utf8").includes(") Z ");
        } catch {
            return false;
        }
    };
    assert.ok(pid > 0);
    await until(() => !runs());
});

test("why there is no image is told", async () => {
    const file = path.join(folder, "other.ray");
    const panel = show(state.open(new Uri(file), SCENE), folder, "no-such-program");
    await until(() => state.errors.length);
    assert.match(state.errors[0], /no-such-program/);
    await panel.dispose();
    state.errors.length = 0;
    const missing = show(state.open(new Uri(file), SCENE), folder, program);
    await until(() => state.errors.length);
    assert.match(state.errors.pop(), /other\.ray/);
    await missing.dispose();
    show(state.open(new Uri("scene", "untitled"), SCENE), folder, program);
    assert.match(state.errors.pop(), /save the scene first/);
});
