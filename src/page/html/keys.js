// Keys.

new ResizeObserver(() => { if (isFit) fit() }).observe(stage)

$('#layers').addEventListener('change', (event) => choose(event.target.value))
$('#exposure input').addEventListener('input', (event) => setExposure(event.target.value))
$('#fit').addEventListener('click', fit)
$('#in').addEventListener('click', () => larger(1))
$('#out').addEventListener('click', () => larger(-1))
$('#steer').addEventListener('click', toggleSteering)
$('#turn').addEventListener('click', turnCamera)
$('#told button').addEventListener('click', close)
$('#fields h2 button').addEventListener('click', close)

/// Zooms in or out or, when dragging moves the camera, moves it closer or away.
const larger = (way) => {
  if (steers) push('dolly', [0, 0], 1.1 ** way)
  else zoomAt(stage.clientWidth / 2, stage.clientHeight / 2, 2 ** way)
}

const layers = [...document.querySelectorAll('#layers input')].map((input) => input.value)
const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }
Object.assign(bindings, {
  0: fit, '+': () => larger(1), '-': () => larger(-1),
  '[': () => setExposure(stops - 0.5), ']': () => setExposure(stops + 0.5), '=': () => setExposure(0),
})
document.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey) return
  if (event.target.matches?.('textarea')) return
  // Sliders and choices need no letters or digits.
  if (event.target.matches?.('input:not([type=range], [type=radio]), select') && event.key !== 'Escape') return
  const { key } = event
  if (layers[key - 1]) choose(layers[key - 1])
  else if (bindings[key]) bindings[key]()
  else if (steers && nudge(event)) { /* the camera moves */ }
  else if (key === 'Escape') steers ? toggleSteering() : close()
  else if (steps[key] && document.activeElement === stage && width) {
    const far = event.shiftKey ? 10 : 1, [x, y] = mark ?? [width >> 1, height >> 1]
    const to = (at, step, side) => mark ? Math.min(side - 1, Math.max(0, at + far * step)) : at
    look([to(x, steps[key][0], width), to(y, steps[key][1], height)])
  } else return
  event.preventDefault()
})

follow()
