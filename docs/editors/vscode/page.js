// A page in a panel.

// Lets a page load nothing but what a policy allows, and runs a script before its own.
exports.guarded = function (html, policy, script = "") {
    const head = `<meta http-equiv="Content-Security-Policy" content="${policy}">\n`;
    const first = script && `<script>\n${script}</script>\n`;
    return html.replace('<meta charset="utf-8">\n', (charset) => charset + head + first);
};
