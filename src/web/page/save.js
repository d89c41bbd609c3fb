// Files of the scene and its picture.

const files = $('#files')
const sayFiles = (said) => { files.querySelector('[role=status]').textContent = said }

const download = (bytes, name, type) => {
  const link = document.createElement('a')
  link.href = URL.createObjectURL(new Blob([bytes], { type }))
  link.download = name
  link.click()
  setTimeout(() => URL.revokeObjectURL(link.href), 60000)
}

/// Makes a file. The painter makes those of the picture.
const file = async (kind) => {
  if (kind === 'ray') return answerOf(200, new TextEncoder().encode(editor.value).buffer)
  if (kind !== 'stl') return painter(`${kind}/${version}`)
  return request(`stl/${version}/${encodeURIComponent(files.querySelector('select').value)}`)
}

const TYPES = { png: 'image/png', exr: 'image/x-exr', stl: 'model/stl', ray: 'text/plain' }

const save = async (kind) => {
  sayFiles(kind === 'stl' ? 'making the mesh' : '')
  const answer = await file(kind)
  if (!answer.ok) return sayFiles(await answer.text())
  const name = $('#name').textContent.toLowerCase().replace(/[^a-z0-9]+/g, '-').replace(/^-|-$/g, '') || 'scene'
  const bytes = await answer.arrayBuffer()
  download(bytes, `${name}.${kind}`, TYPES[kind])
  sayFiles(`${name}.${kind}: ${bytes.byteLength.toLocaleString('en')} bytes`)
  root.dataset.saved = `${kind} ${bytes.byteLength}`
}

files.addEventListener('click', (event) => { if (event.target.dataset.file) save(event.target.dataset.file) })
files.addEventListener('toggle', async () => {
  sayFiles('')
  if (!files.open) return
  const names = await ask(`objects/${version}`, 'json') ?? [], select = files.querySelector('select')
  select.replaceChildren(...names.map((name) => new Option(visible(name), name)))
  // In a surface's scene, the first object clips the surface.
  if (names.includes('surface')) select.value = 'surface'
})
document.addEventListener('pointerdown', (event) => { if (!files.contains(event.target)) files.open = false })
