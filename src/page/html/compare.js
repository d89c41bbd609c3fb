// Compares two images: left of a line an earlier one or one by other means, right of it the current one.

const box = $('#comparing'), beforeCanvas = $('#before'), divider = $('#line')
// The image left of the line: its colours, its size, and the version of its scene if that must be the current one.
let before = null
// The position of the line, in percent of the image's width.
let line = 50
// Whether the current image is to be pinned as soon as it is complete.
let pins = false
let otherAsked = null

const isComplete = () => width > 0 && ready >= width * height
const compares = () => !box.hidden
const means = () => $('#comparing select').value
const tellDifference = (said) => { $('#comparing span').textContent = said }

const moveLine = (to) => {
  line = Math.min(100, Math.max(0, to))
  $('#comparing input').value = line
  divider.style.left = `${line}%`
  beforeCanvas.style.clipPath = `inset(0 ${100 - line}% 0 0)`
}

/// Whether the image left of the line shows an earlier scene. A new one by other means is then on its way.
const isStale = () => before?.of && before.of !== version

const fits = () => before && before.size[0] === width && before.size[1] === height

/// Draws the image left of the line, if it has the current size. Other layers have none.
const showBefore = () => {
  const isSeen = compares() && layer === 'picture' && fits()
  beforeCanvas.hidden = divider.hidden = !isSeen
  if (!isSeen) return
  if (beforeCanvas.width !== width || beforeCanvas.height !== height) [beforeCanvas.width, beforeCanvas.height] = [width, height]
  expose(0, 0, width, height, before.colours, beforeCanvas.getContext('2d'))
  moveLine(line)
}

/// Describes the difference of two images, in levels from 0 to 255, in the words of `tabray diff`.
const difference = (old, now) => {
  const count = (number, noun) => `${number} ${noun}${number === 1 ? '' : 's'}`
  let differing = 0, largest = 0, squares = 0
  for (let pixel = 0; pixel < now.length; pixel += 3) {
    let most = 0
    const [one, other] = [bytesOf(old, pixel), bytesOf(now, pixel)]
    for (let channel = 0; channel < 3; channel++) {
      const apart = Math.abs(one[channel] - other[channel])
      most = Math.max(most, apart)
      squares += apart * apart
    }
    if (most) differing++
    largest = Math.max(largest, most)
  }
  const all = count(now.length / 3, 'pixel')
  if (!differing) return `none of ${all} differs`
  const percent = (300 * differing / now.length).toFixed(4)
  return `${differing} of ${all} ${differing === 1 ? 'differs' : 'differ'} (${percent} %); ` +
    `largest difference ${count(largest, 'level')}, RMS ${Math.sqrt(squares / now.length).toFixed(4)}`
}

/// Compares the current image, once it is complete, with the one left of the line.
const compare = () => {
  if (!compares() || !isComplete()) return
  if (pins) {
    pins = false
    before = { colours: colours.slice(), size: [width, height] }
    showBefore()
  }
  if (!before || isStale()) return
  tellDifference(fits() ? difference(before.colours, colours) : `the image before has ${before.size.join(' × ')} pixels, and this one ${width} × ${height}`)
  root.dataset.compared = `${version} ${means()}`
}

/// Compares again after a change of the scene or of the image left of the line.
const compareNext = () => {
  if (!compares()) return
  delete root.dataset.compared
  if (means() === 'pinned') {
    if (pins && !isComplete()) tellDifference('the image will be pinned once it is complete')
    showBefore()
  } else fetchOther()
}

/// Requests an image of the current scene by other means.
const fetchOther = async () => {
  const of = version, how = means(), size = [width, height]
  otherAsked?.abort()
  otherAsked = new AbortController()
  tellDifference('rendering the other image')
  const answer = await request(`other/${of}/${how}`, { signal: otherAsked.signal }).catch(() => null)
  const isWanted = () => of === version && how === means() && compares()
  if (!answer || !isWanted()) return
  if (!answer.ok) return tellDifference((await answer.text()).trim())
  const bytes = await answer.arrayBuffer().catch(() => null)
  if (!bytes || !isWanted()) return
  before = { colours: new Float32Array(bytes), size, of }
  tellDifference('')
  showBefore()
  compare()
}

const pin = () => {
  otherAsked?.abort()
  $('#comparing select').value = 'pinned'
  pins = true
  compareNext()
  compare()
}

const toggleComparing = () => {
  box.hidden = !box.hidden
  $('#compare').setAttribute('aria-pressed', compares())
  if (compares()) return pin()
  if (box.contains(document.activeElement)) stage.focus()
  otherAsked?.abort()
  before = null
  tellDifference('')
  delete root.dataset.compared
  showBefore()
}

$('#comparing button').addEventListener('click', pin)
$('#comparing input').addEventListener('input', (event) => moveLine(+event.target.value))
$('#comparing select').addEventListener('change', () => {
  before = null
  showBefore()
  if (means() === 'pinned') pin(); else compareNext()
})

// A drag of the line must not reach the stage.
const lineTo = (event) => {
  const { left, width: wide } = sheet.getBoundingClientRect()
  moveLine(100 * (event.clientX - left) / wide)
}
divider.addEventListener('pointerdown', (event) => {
  event.stopPropagation()
  divider.setPointerCapture(event.pointerId)
})
divider.addEventListener('pointermove', (event) => {
  if (!divider.hasPointerCapture(event.pointerId)) return
  event.stopPropagation()
  lineTo(event)
})

on.scene.push(compareNext)
on.done.push(compare)
on.drawn.push(showBefore)
Object.assign(bindings, { d: toggleComparing, ',': () => moveLine(line - 2), '.': () => moveLine(line + 2) })
$('#compare').addEventListener('click', toggleComparing)
