// Pointer and keys.

const HINT = 'click a pixel to explain it, use the wheel to zoom, drag to pan'
$('#under').textContent = HINT
let drag = null

stage.addEventListener('pointerdown', (event) => {
  if (event.target.closest('#report') || event.button !== 0) return
  drag = { x: event.clientX, y: event.clientY, offset, moved: false }
  stage.setPointerCapture(event.pointerId)
})
stage.addEventListener('pointermove', (event) => {
  if (drag) {
    const by = [event.clientX - drag.x, event.clientY - drag.y]
    drag.moved ||= Math.hypot(...by) > 4
    if (!drag.moved) return
    stage.classList.add('drags')
    offset = drag.offset.map((place, side) => place + by[side])
    isFit = false
    place()
    return
  }
  const at = under(event)
  const from = at && 3 * (at[1] * width + at[0])
  $('#under').textContent = at
    ? `${at[0]} ${height - 1 - at[1]}   (${[...colours.subarray(from, from + 3)].map(short).join(', ')})` : HINT
})
stage.addEventListener('pointerup', (event) => {
  const at = drag && !drag.moved && under(event)
  drag = null
  stage.classList.remove('drags')
  if (at) look(at)
})
stage.addEventListener('pointercancel', () => { drag = null; stage.classList.remove('drags') })
stage.addEventListener('wheel', (event) => {
  if (event.target.closest('#report')) return
  event.preventDefault()
  const box = stage.getBoundingClientRect()
  zoomAt(event.clientX - box.left, event.clientY - box.top, 2 ** (-event.deltaY / (event.deltaMode ? 8 : 240)))
}, { passive: false })
new ResizeObserver(() => { if (isFit) fit() }).observe(stage)

$('#layers').addEventListener('change', (event) => choose(event.target.value))
$('#exposure input').addEventListener('input', (event) => setExposure(event.target.value))
$('#fit').addEventListener('click', fit)
$('#told button').addEventListener('click', close)
$('#fields h2 button').addEventListener('click', close)

const layers = [...document.querySelectorAll('#layers input')].map((input) => input.value)
const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }
document.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey) return
  if (event.target.matches?.('#fields input, #fields select') && event.key !== 'Escape') return
  const { key } = event
  const middle = (factor) => zoomAt(stage.clientWidth / 2, stage.clientHeight / 2, factor)
  if (layers[key - 1]) choose(layers[key - 1])
  else if (key === '0') fit()
  else if (key === 'v') refresh()
  else if (key === '+') middle(2)
  else if (key === '-') middle(1 / 2)
  else if (key === '[') setExposure(stops - 0.5)
  else if (key === ']') setExposure(stops + 0.5)
  else if (key === '=') setExposure(0)
  else if (key === 'Escape') close()
  else if (steps[key] && document.activeElement === stage && width) {
    const far = event.shiftKey ? 10 : 1, [x, y] = mark ?? [width >> 1, height >> 1]
    const to = (at, step, side) => mark ? Math.min(side - 1, Math.max(0, at + far * step)) : at
    look([to(x, steps[key][0], width), to(y, steps[key][1], height)])
  } else return
  event.preventDefault()
})

follow()
