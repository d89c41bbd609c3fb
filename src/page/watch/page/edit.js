// The scene's text, changed here and saved into its file.

// The text that is being changed, as it was.
let original = ''

const showEditor = (isOpen) => {
  for (const part of ['#paper', '#save', '#leave']) $(part).hidden = !isOpen
  for (const part of ['#text', '#edit']) $(part).hidden = isOpen
  $('#unsaved').hidden = true
}

const drawEdited = () => {
  $('#ground').replaceChildren(...rows($('#editor').value))
  scrollGround()
}

const edit = () => {
  if (!$('#paper').hidden) return
  selectTab($('#tab-text'))
  original = $('#editor').value = current
  sayEdited('')
  showEditor(true)
  drawEdited()
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
$('#editor').addEventListener('input', drawEdited)
$('#editor').addEventListener('scroll', scrollGround)
$('#editor').addEventListener('keydown', (event) => {
  if (event.key === 's' && (event.ctrlKey || event.metaKey)) { event.preventDefault(); save() }
  // A text that was changed is left by its button alone.
  if (event.key === 'Escape' && $('#editor').value === original) $('#leave').click()
})

bindings.e = edit
