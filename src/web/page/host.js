// The page within an editor that has the text. The page sends its changes and receives the editor's.

/// The connection to the editor, if there is one.
const hosted = window.acquireVsCodeApi && (() => {
  const editing = window.acquireVsCodeApi()
  let last = null, begins
  const first = new Promise((done) => { begins = done })
  const texts = ({ text }) => {
    const isFirst = last === null
    last = text
    if (isFirst) begins(text)
    else if (painter && text !== editor.value) setText(text)
  }
  window.addEventListener('message', ({ data }) => {
    if (typeof data.text === 'string') texts(data)
    else if (data.files) {
      for (const { name, bytes } of data.files) give(name, new Uint8Array(bytes))
      changed()
    }
  })
  on.scene.push(() => {
    if (editor.value === last) return
    editing.postMessage({ text: editor.value, before: last })
    last = editor.value
  })
  root.classList.add('hosted')
  selectTab($('#tab-plan'))
  editing.postMessage({ ready: true })
  return { first, lacks: (names) => { if (names.length) editing.postMessage({ lacks: names }) } }
})()
