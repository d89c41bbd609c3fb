// The scene's text.

const lineAt = (line) => $('#text').children[line - 1]

const write = (text) => {
  $('#text').replaceChildren(...text.split('\n').map((line) => {
    const row = document.createElement('div')
    row.textContent = line
    return row
  }))
}

const markLines = (lines) => {
  for (const row of document.querySelectorAll('#text .marked')) row.classList.remove('marked')
  if (!lines) return
  for (let line = lines[0]; line <= lines[1]; line++) lineAt(line)?.classList.add('marked')
  lineAt(lines[1])?.scrollIntoView({ block: 'nearest' })
  lineAt(lines[0])?.scrollIntoView({ block: 'nearest' })
}
