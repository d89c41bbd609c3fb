// The address holds the scene: the text after its # is compressed.

const through = async (bytes, stream) => new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer())

const addressOf = async (text) => {
  const bytes = await through(new TextEncoder().encode(text), new CompressionStream('deflate-raw'))
  const letters = Array.from(bytes, (byte) => String.fromCharCode(byte)).join('')
  return `#scene=${btoa(letters).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '')}`
}

// Why the address has no scene, although it should have one.
let misled = ''
const tellMisled = () => { if (misled) report(`error: ${misled}`, false) }

/// The text of the address. `#surface=NAME` and `#formula=FORMULA` are short forms.
const textOfAddress = async () => {
  const [, kind, value] = location.hash.match(/^#(scene|surface|formula)=(.*)$/) ?? []
  misled = ''
  if (!kind) return null
  try {
    if (kind !== 'scene') {
      const isNamed = kind === 'surface', formula = decodeURIComponent(value)
      const answer = await (isNamed ? helper(`surface/${value}`) : helper('formula/change', JSON.stringify({ text: '', formula })))
      if (answer.ok) return isNamed ? answer.text() : (await answer.json()).text
      misled = await answer.text()
      return null
    }
    const letters = atob(value.replaceAll('-', '+').replaceAll('_', '/'))
    const bytes = Uint8Array.from(letters, (letter) => letter.charCodeAt(0))
    return new TextDecoder().decode(await through(bytes, new DecompressionStream('deflate-raw')))
  } catch {
    misled = 'the address of this page is not whole: what it had of a scene cannot be read'
    return null
  }
}

// The part of the address that this page wrote.
let own = ''
const writeAddress = async () => {
  own = await addressOf(editor.value)
  if (location.hash !== own) history.replaceState(null, '', own)
}
let waitsToShare = 0
const shareSoon = () => {
  if (hosted) return
  clearTimeout(waitsToShare)
  waitsToShare = setTimeout(writeAddress, 400)
}

on.scene.push(shareSoon)
window.addEventListener('hashchange', async () => {
  if (location.hash === own) return
  const text = await textOfAddress()
  if (text !== null) await setText(text)
  tellMisled()
})
$('#share').addEventListener('click', async () => {
  await writeAddress()
  const isCopied = await navigator.clipboard?.writeText(location.href).then(() => true, () => false)
  const words = isCopied ? 'the address is copied' : 'the address of this page has the scene'
  $('#share').textContent = isCopied ? 'copied' : 'see the address'
  announce(words)
  setTimeout(() => { $('#share').textContent = 'share' }, 2000)
})
