// The scene's text.

const lineAt = (line) => $('#text').children[line - 1]

// The text that came last.
let current = ''

const write = (text) => {
  current = text
  $('#text').replaceChildren(...rows(text.split('\n').map(visible).join('\n')))
}

// The first and the last line of the object that is explained.
let marked = []

const markLines = (lines) => {
  marked = lines ?? []
  for (const row of document.querySelectorAll('#text .marked')) row.classList.remove('marked')
  if (!lines) return
  for (let line = lines[0]; line <= lines[1]; line++) lineAt(line)?.classList.add('marked')
  reveal(lines)
}

/// Scrolls the text, and nothing around it, to lines, given by the first and the last.
const reveal = (lines) => {
  for (const row of [...lines].reverse().map(lineAt)) {
    if (!row) continue
    const pane = $('#text'), [its, all] = [row, pane].map((one) => one.getBoundingClientRect())
    const margin = Math.min(64, all.height / 4)
    if (its.top < all.top + margin) pane.scrollTop += its.top - all.top - margin
    else if (its.bottom > all.bottom - margin) pane.scrollTop += its.bottom - all.bottom + margin
  }
}

/// Marks the lines that have errors.
const markWrong = (lines) => {
  for (const line of lines) lineAt(line)?.classList.add('wrong')
  reveal(lines.slice(0, 1))
}
