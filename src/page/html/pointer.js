// The pointer on the image: a click explains a pixel, and dragging moves the sheet or the camera.

// The positions of the pointers on the image; each finger is a pointer.
const fingers = new Map()
let drag = null

const middle = () => [0, 1].map((side) => [...fingers.values()].reduce((sum, at) => sum + at[side], 0) / fingers.size)
const spread = () => {
  const [one, other] = [...fingers.values()]
  return other ? Math.hypot(one[0] - other[0], one[1] - other[1]) : 1
}

/// Begins a drag, again whenever a finger comes or goes.
const grasp = (event) => {
  const pans = event.shiftKey || event.button === 2 || fingers.size > 1
  drag = fingers.size
    ? { from: middle(), spread: spread(), offset, zoom, moved: drag?.moved ?? false, gesture: steers && grip(pans ? 'pan' : 'orbit') }
    : null
  stage.classList.toggle('drags', drag?.moved ?? false)
}

stage.addEventListener('pointerdown', (event) => {
  if (event.button === 1 || event.button === 2 && !steers) return
  stage.setPointerCapture(event.pointerId)
  fingers.set(event.pointerId, [event.clientX, event.clientY])
  grasp(event)
})
stage.addEventListener('pointermove', (event) => {
  if (!drag || !fingers.has(event.pointerId)) return tellPixel(under(event))
  fingers.set(event.pointerId, [event.clientX, event.clientY])
  const to = middle(), by = to.map((place, side) => place - drag.from[side]), factor = spread() / drag.spread
  drag.moved ||= Math.hypot(...by) > 4 || fingers.size > 1
  if (!drag.moved) return
  stage.classList.add('drags')
  if (drag.gesture) return steer(drag.gesture, by, factor)
  const box = stage.getBoundingClientRect(), corner = [box.left, box.top]
  zoom = drag.zoom
  offset = drag.offset.map((place, side) => place + by[side])
  zoomAt(to[0] - corner[0], to[1] - corner[1], factor)
})
const release = (event) => {
  if (!fingers.delete(event.pointerId)) return
  const at = event.type === 'pointerup' && !drag.moved && under(event)
  grasp(event)
  if (at) look(at)
  else if (!drag && steers && mark) explain(mark)
}
stage.addEventListener('pointerup', release)
stage.addEventListener('pointercancel', release)
stage.addEventListener('contextmenu', (event) => { if (steers) event.preventDefault() })
stage.addEventListener('wheel', (event) => {
  event.preventDefault()
  const box = stage.getBoundingClientRect(), factor = 2 ** (-event.deltaY / (event.deltaMode ? 8 : 240))
  if (steers) push('dolly', [0, 0], factor)
  else zoomAt(event.clientX - box.left, event.clientY - box.top, factor)
}, { passive: false })

const tellPixel = (at) => {
  const from = at && 3 * (at[1] * width + at[0])
  $('#under').textContent = at && !complaint
    ? `${at[0]} ${height - 1 - at[1]}   (${[...colours.subarray(from, from + 3)].map(short).join(', ')})` : hint()
}
$('#under').textContent = hint()
