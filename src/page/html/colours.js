// The colours of a text.

// Pieces of a line that have a colour, by their kind.
const PIECES = new RegExp([
  /(?<comment>#.*)/,
  /(?<quoted>"(?:[^"\\]|\\.)*"?)/,
  /(?<keyword>(?<![^\s{}])(?:let|repeat|include)(?=\s))/,
  // A word before a name and a brace, or before a name at the end of the line, or the head of a table.
  /(?<type>(?<=(?:^|[{}])\s*)[a-z][\w-]*(?=(?:\s+[^\s{}#"]+)?\s*\{)|^[a-z][\w-]*(?=\s+[^\s{}#"=]+\s*$)|^\[.*\])/,
  /(?<number>(?<![^\s{}=[,])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?%?(?![^\s{}\],]))/,
].map(({ source }) => source).join('|'), 'gi')

/// The nodes of a part of a line, in their colours.
const coloured = (line, first = 0, last = line.length) => {
  const nodes = []
  const add = (kind, from, to) => {
    const text = line.slice(Math.max(from, first), Math.max(first, Math.min(to, last)))
    if (!text) return
    const piece = document.createElement('span')
    piece.className = kind
    piece.textContent = text
    nodes.push(kind ? piece : text)
  }
  let at = 0
  for (const { index, 0: piece, groups } of line.matchAll(PIECES)) {
    add('', at, index)
    at = index + piece.length
    add(Object.keys(groups).find((kind) => groups[kind]), index, at)
  }
  add('', at, line.length)
  return nodes
}

/// The lines of a text in their colours.
const rows = (text) => text.split('\n').map((line) => {
  const row = document.createElement('div')
  row.append(...coloured(line))
  return row
})

/// Keeps the ground of an editor behind its text.
const scrollGround = () => {
  const { scrollTop, scrollLeft } = $('#editor')
  Object.assign($('#ground'), { scrollTop, scrollLeft })
}
