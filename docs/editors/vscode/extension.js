// Starts `tabray lsp` for scenes, and `tabray watch` for the scene whose image is asked for.

const { window, workspace, commands } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

function program() {
    return workspace.getConfiguration("tabray").get("path", "tabray");
}

function watch() {
    const document = window.activeTextEditor?.document;
    if (!document || document.uri.scheme !== "file") {
        window.showErrorMessage("tabray: save the scene first");
        return;
    }
    const name = `tabray ${workspace.asRelativePath(document.uri)}`;
    const open = window.terminals.find((terminal) => terminal.name === name && terminal.exitStatus === undefined);
    // Without a shell, so that no file name can be a command.
    const shellArgs = ["watch", "--open", document.uri.fsPath];
    (open ?? window.createTerminal({ name, shellPath: program(), shellArgs })).show(true);
}

exports.activate = function (context) {
    context.subscriptions.push(commands.registerCommand("tabray.watch", watch));
    const documentSelector = [{ language: "tabray" }, { language: "toml" }];
    client = new LanguageClient("tabray", "tabray", { command: program(), args: ["lsp"] }, { documentSelector });
    return client.start();
};

exports.deactivate = function () {
    return client?.stop();
};
