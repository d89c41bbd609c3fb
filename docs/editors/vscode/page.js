// A page in a panel.

// A panel leaves room beside its text, of which a page has none.
const STYLE = "<style>html > body { padding: 0 }</style>\n";

// Lets a page load nothing but what a policy allows, and runs a script before its own.
exports.guarded = function (html, policy, script = "") {
    const head = `<meta http-equiv="Content-Security-Policy" content="${policy}">\n${STYLE}`;
    const first = script && `<script>\n${script}</script>\n`;
    return html.replace('<meta charset="utf-8">\n', (charset) => charset + head + first);
};
