// The scene's text.

const lineAt = (line) => $('#text').children[line - 1]

// The text that came last, and the one that is being changed, as it was.
let current = '', original = ''

const write = (text) => {
  current = text
  $('#text').replaceChildren(...text.split('\n').map((line) => {
    const row = document.createElement('div')
    row.textContent = visible(line)
    return row
  }))
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

const showEditor = (isOpen) => {
  for (const part of ['#editor', '#save', '#leave']) $(part).hidden = !isOpen
  for (const part of ['#text', '#edit']) $(part).hidden = isOpen
  $('#unsaved').hidden = true
}

const edit = () => {
  if (!$('#editor').hidden) return
  selectTab($('#tab-text'))
  original = $('#editor').value = current
  sayEdited('')
  showEditor(true)
  $('#editor').setSelectionRange(0, 0)
  $('#editor').focus()
}

const sayEdited = (said) => { $('#editing span').textContent = said }

/// Saves the text, if the file still has the text that was there when the changes began.
const save = async () => {
  const hash = new Uint8Array(await crypto.subtle.digest('SHA-256', new TextEncoder().encode(original)))
  const digits = Array.from(hash, (byte) => byte.toString(16).padStart(2, '0')).join('')
  const text = $('#editor').value, answer = await post(`save/${digits}`, text)
  const said = answer ? (await answer.text()).trim() : 'tabray is not running'
  const [first, ...rest] = said.split('\n')
  sayEdited(answer?.status === 413 ? 'the text is too long to be saved here' : first)
  $('#unsaved').textContent = rest.join('\n')
  $('#unsaved').hidden = answer?.ok || !rest.length
  if (!answer?.ok) return
  showEditor(false)
  $('#text').focus()
}

$('#edit').addEventListener('click', edit)
$('#save').addEventListener('click', save)
$('#leave').addEventListener('click', () => { showEditor(false); sayEdited(''); $('#text').focus() })
$('#editor').addEventListener('keydown', (event) => {
  if (event.key === 's' && (event.ctrlKey || event.metaKey)) { event.preventDefault(); save() }
  // A text that was changed is left by its button alone.
  if (event.key === 'Escape' && $('#editor').value === original) $('#leave').click()
})
