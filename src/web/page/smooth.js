// The picture with the pixels of the screen and smooth edges, above the one with the scene's pixels, once nothing has
// changed for a moment.

// The time in milliseconds without a change, and the maximum number of pixels.
const REST = 250, MOST_PIXELS = 2 ** 21

const fine = document.createElement('canvas')
fine.id = 'fine'
fine.hidden = true
canvas.after(fine)

// The workers, each of which paints a part; the version and the size that they paint.
let smoothers = [], smooth = { of: 0, size: [0, 0], begun: 0 }

const hearSmooth = (data) => {
  if (+data.version !== smooth.of) return
  if (data.paint) return eachArea(data.paint, (left, top, wide, high, block, isFinal, given, bytes) => {
    const image = new ImageData(wide, high)
    for (let from = 0, to = 0; from < bytes.length; from += 3, to += 4) image.data.set([bytes[from], bytes[from + 1], bytes[from + 2], 255], to)
    fine.getContext('2d').putImageData(image, left, top)
  })
  if (data.painted === undefined || --smooth.left) return
  root.dataset.smooth = Math.round(performance.now() - smooth.begun)
}

/// The size of the picture in pixels of the screen.
const sizeOnScreen = () => {
  const scale = Math.min(zoom * devicePixelRatio, Math.sqrt(MOST_PIXELS / (width * height)))
  return [width, height].map((side) => Math.max(1, Math.round(side * scale)))
}

const smoothen = async () => {
  const isSeen = layer === 'picture' && !stops && !compares() && textIsThePicture && isComplete()
  const size = sizeOnScreen(), isThere = smooth.of === version && smooth.size.join() === size.join()
  // A picture that is only enlarged to see its pixels stays.
  if (!isSeen || isThere || zoom > 4 && !isFit) return
  const count = Math.min(4, navigator.hardwareConcurrency ?? 2)
  smooth = { of: version, size, left: count, begun: performance.now() }
  delete root.dataset.smooth
  const mine = smooth
  if (!smoothers.length) smoothers = await Promise.all(Array.from({ length: count }, () => start(program, hearSmooth)))
  if (smooth !== mine) return
  ;[fine.width, fine.height] = size
  showFine()
  smoothers.forEach((ask, index) => ask(`smooth/${smooth.of}/${size.join('/')}/${index}/${count}`, painted.text, true))
}

const showFine = () => {
  fine.hidden = smooth.of !== version || layer !== 'picture' || stops !== 0 || compares() || zoom > 4 && !isFit
}

let rest = 0
const smoothenSoon = () => {
  showFine()
  clearTimeout(rest)
  rest = setTimeout(smoothen, REST)
}

on.scene.push(() => {
  smooth = { of: 0, size: [0, 0] }
  for (const ask of smoothers) ask.stop()
})
for (const what of ['scene', 'done', 'drawn', 'placed']) on[what].push(smoothenSoon)
