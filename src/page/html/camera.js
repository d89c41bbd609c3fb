// The camera by pointer and keys: orbit, pan and dolly.

// Whether dragging moves the camera.
let steers = false
// The point of the orbit, and whether it was clicked. After a pan, the middle of the image shows another point.
let around = null, isClicked = false
// The camera's name, whether its image plane is fixed, and whether it can become a camera without a fixed one.
let cameraName = '', isWindow = false, turns = false

// The angle in degrees by which the scene turns for each pixel of the screen.
const TURN = 0.3
// The time in milliseconds within which turns of the wheel or keys are one gesture.
const TOGETHER = 400

// The reason why the camera was not moved.
let complaint = ''

const WINDOW = '; the image plane stays, which shears what is seen from the side'
const TURNS = ': key l turns the camera into a look_at'
const hint = () => {
  if (complaint) return complaint
  const [click, more, zoom] = matchMedia('(pointer: coarse)').matches
    ? ['tap', 'with two fingers', 'pinch'] : ['click', 'with Shift', 'use the wheel']
  if (!steers) return `${click} a pixel to explain it, ${zoom} to zoom, drag to pan`
  return `drag to orbit, ${more} to pan, ${zoom} to move closer; ${click} the point to orbit around${isWindow ? WINDOW : ''}${turns ? TURNS : ''}`
}

/// The point that a pixel shows. If a new image is on its way, waits for it.
const pointAt = async (at) => {
  for (let tries = 0; tries < 10; tries++) {
    const answer = await request(`point/${version}/${at[0]}/${height - 1 - at[1]}`).catch(() => null)
    if (answer?.ok) return answer.json()
    await new Promise((soon) => setTimeout(soon, 50))
  }
  return null
}

/// Makes the camera orbit the point that a pixel shows.
const turnAround = async (at) => {
  around = pointAt(at)
  isClicked = true
}

/// Begins a movement of the camera: a drag, or turns of the wheel or keys in close succession.
const grip = (how) => {
  complaint = ''
  return { how, point: null, from: null, wanted: null, isQueued: false, isRefused: false }
}

let queue = Promise.resolve()
const send = async (gesture) => {
  around ??= pointAt([width >> 1, height >> 1])
  gesture.point ??= await around
  if (!gesture.point) {
    around = null
    return complain(null)
  }
  if (!gesture.from) {
    const answer = await request('camera').catch(() => null)
    gesture.isRefused = !answer?.ok
    if (gesture.isRefused) return complain(answer)
    gesture.from = await answer.json()
    for (const attribute of Object.keys(gesture.from.stand)) tried.add(`${gesture.from.name} ${attribute}`)
  }
  while (gesture.wanted) {
    const body = JSON.stringify({ stand: gesture.from.stand, around: gesture.point, ...gesture.wanted })
    gesture.wanted = null
    const answer = await post('move', body)
    await complain(answer)
  }
  if (gesture.how === 'pan' && !isClicked) around = null
}

/// Shows why the camera was not moved, if so.
const complain = async (answer) => {
  complaint = answer?.ok ? '' : answer ? (await answer.text()).trim() : 'tabray is not running'
  $('#under').textContent = hint()
  $('#fields p span').textContent = complaint
}

/// Moves the camera by this many pixels of the screen since the gesture began, and divides its distance by a factor.
/// While the program is busy with earlier movements, only the latest one is kept.
const steer = (gesture, [right, down], factor) => {
  const by = (scale) => [right * scale, -down * scale]
  const isPan = gesture.how === 'pan'
  gesture.wanted = { orbit: isPan ? [0, 0] : by(TURN), pan: isPan ? by(1 / zoom) : [0, 0], dolly: factor }
  if (gesture.isQueued || gesture.isRefused) return
  gesture.isQueued = true
  queue = queue.then(() => send(gesture)).catch(() => {}).then(() => { gesture.isQueued = false })
}

/// Moves the camera further, as part of the same gesture if the last push was a moment ago.
let pushed = null
const push = (how, by, factor) => {
  const now = performance.now()
  if (pushed?.gesture.how !== how || now - pushed.at > TOGETHER) pushed = { gesture: grip(how), by: [0, 0], factor: 1 }
  pushed.at = now
  pushed.by = pushed.by.map((before, side) => before + by[side])
  pushed.factor *= factor
  steer(pushed.gesture, pushed.by, pushed.factor)
}

/// Moves the camera if the key is an arrow.
const nudge = ({ key, shiftKey }) => {
  const step = steps[key]
  if (!step || document.activeElement !== stage) return false
  push(shiftKey ? 'pan' : 'orbit', step.map((side) => side * 10), 1)
  return true
}

/// Fetches the camera's properties, and offers a camera that truly orbits in place of one with a fixed image plane.
const learnCamera = async () => {
  const answer = await request('camera').catch(() => null)
  const camera = answer?.ok ? await answer.json() : null
  cameraName = camera?.name ?? ''
  isWindow = camera?.is_window ?? false
  turns = camera?.turns ?? false
  $('#turn').hidden = !steers || !turns
  $('#under').textContent = hint()
}

/// Turns the camera into one that truly orbits.
const turnCamera = async () => {
  if ($('#turn').hidden) return
  await queue
  const answer = await post('turn', '')
  await complain(answer)
  stage.focus()
  if (!answer?.ok) return
  $('#fields p span').textContent = (await answer.text()).trim()
}

const toggleSteering = () => {
  steers = !steers
  $('#steer').setAttribute('aria-pressed', steers)
  stage.classList.toggle('steers', steers)
  if (!isClicked) around = null
  complaint = ''
  learnCamera()
  $('#under').textContent = hint()
  if (!steers) return
  // Shows the camera's values, which will change.
  shown = null
  refresh()
  stage.focus()
}

bindings.c = toggleSteering
bindings.l = turnCamera
