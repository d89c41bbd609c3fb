// The shown scene: events and messages.

// The warnings about the scene.
let warnings = ''

/// A scene arrives. Its picture follows in parts.
const begin = (scene) => {
  version = scene.version
  display = scene.display
  root.dataset.version = version
  ready = 0
  title(scene.name)
  resize(scene.size)
  textIsThePicture = true
  write(scene.text)
  warnings = scene.warnings
  report(warnings, true)
  state('rendering', 'rendering')
  happens('scene')
  if (mark && !drag?.gesture) explain(mark)
  if (shown) refresh()
  if (steers && !drag) learnCamera()
  if (layer !== 'picture') fetchLayer()
}

/// The picture is complete.
const finish = ({ version: of, seconds }) => {
  if (of !== version) return
  happens('done')
  if (root.dataset.state === 'rendering') state('done', `${width} × ${height}, ${seconds.toFixed(2)} s`)
  requestAnimationFrame(() => { root.dataset.shown = version; root.dataset.shownAt = Date.now() })
}

/// There is a remark on the complete picture.
const remark = ({ version: of, words }) => {
  if (of === version) report([warnings, words].filter(Boolean).join('\n'), true)
}

/// The scene has errors.
const refuse = (fault) => {
  title(fault.name)
  textIsThePicture = false
  if (fault.text !== null) write(fault.text)
  markWrong(fault.lines)
  report(fault.report, false)
  state('broken', version ? 'the last good image' : 'no image yet')
}

const title = (name) => { $('#name').textContent = name; document.title = `${name} – tabray` }

const report = (words, warns) => {
  const box = $('#report')
  box.textContent = words
  box.hidden = !words
  box.classList.toggle('warns', warns)
}
