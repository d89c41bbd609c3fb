// The program that is tested, which TABRAY can name, and the scenes of the repository.

const fs = require("node:fs");
const path = require("node:path");

const root = path.join(__dirname, "../../../..");
const built = ["dist", "release"].map((profile) => path.join(root, "target", profile, "tabray")).filter(fs.existsSync);

exports.program = process.env.TABRAY ?? built[0] ?? "tabray";
exports.scenes = path.join(root, "scenes");
