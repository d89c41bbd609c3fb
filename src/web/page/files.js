// Files that the scene names. They are dropped onto the page or chosen, and kept in memory.

// The maximum size of all files together, in bytes. Pictures need memory as well.
const MOST_BYTES = 2 ** 28

// The files that the scene names but the page does not have.
let lacking = []
const lack = (names) => {
  lacking = names
  root.dataset.lacking = names.join(' ')
  hosted?.lacks(names)
}

const lastOf = (path) => path.split(/[\\/]/).at(-1)

/// Keeps a file. Another of its name is replaced if the user says so.
const keep = async (file) => {
  const bytes = new Uint8Array(await file.arrayBuffer()), before = kept.get(encodeURIComponent(file.name))
  const isOther = before && (before.length !== bytes.length || before.some((byte, at) => byte !== bytes[at]))
  if (!isOther || confirm(`The page has another file with the name ${visible(file.name)}. Replace it?`)) give(file.name, bytes)
}

/// Takes files. A scene becomes the text, unless the current scene includes it; the others are kept.
const take = async (list) => {
  let text = null, bytes = [...kept.values()].reduce((sum, one) => sum + one.length, 0)
  for (const file of list) {
    bytes += file.size
    if (bytes > MOST_BYTES) return report(`error: the files are larger than ${MOST_BYTES >> 20} MiB in all, which is too much for a page`, false)
    const isScene = /\.(ray|toml)$/i.test(file.name) && !lacking.some((path) => lastOf(path) === file.name)
    if (isScene) text = await file.text()
    else await keep(file)
  }
  if (text === null) await changed()
  else await setText(text)
  root.dataset.kept = kept.size
  announce(`${list.length} ${list.length === 1 ? 'file is' : 'files are'} on the page`)
}

const isOfFiles = (event) => event.dataTransfer?.types.includes('Files')
document.addEventListener('dragover', (event) => { if (isOfFiles(event)) event.preventDefault() })
document.addEventListener('drop', (event) => {
  if (!isOfFiles(event)) return
  event.preventDefault()
  take([...event.dataTransfer.files])
})
$('#open').addEventListener('click', () => $('#chosen').click())
$('#chosen').addEventListener('change', async ({ target }) => {
  await take([...target.files])
  target.value = ''
})
