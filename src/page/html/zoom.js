// Zoom, and the explained pixel.

let mark = null
let zoom = 1, offset = [0, 0], isFit = true
// The pixels of the screen around an image that fills its place, on both sides together.
const MARGIN = 16

const place = () => {
  canvas.style.imageRendering = zoom > 4 ? 'pixelated' : ''
  sheet.style.transform = `translate(${offset[0]}px, ${offset[1]}px) scale(${zoom})`
  sheet.style.setProperty('--screen', `${1 / zoom}px`)
  happens('placed')
  if (!mark) return
  // The mark has the same width at any zoom.
  const [left, top] = mark.map((at, side) => `${offset[side] + zoom * at}px`)
  Object.assign($('#mark').style, { left, top, width: `${zoom}px`, height: `${zoom}px` })
}

const fit = () => {
  const { clientWidth, clientHeight } = stage
  if (!width || !clientWidth) return
  zoom = Math.min((clientWidth - MARGIN) / width, (clientHeight - MARGIN) / height)
  offset = [(clientWidth - zoom * width) / 2, (clientHeight - zoom * height) / 2].map(Math.round)
  isFit = true
  place()
}

const zoomAt = (x, y, factor) => {
  const next = Math.min(64, Math.max(1 / 32, zoom * factor))
  offset = [x - (x - offset[0]) * next / zoom, y - (y - offset[1]) * next / zoom]
  zoom = next
  isFit = false
  place()
}

/// The pixel under the pointer, from the left and from the top.
const under = (event) => {
  const box = stage.getBoundingClientRect()
  const at = [event.clientX - box.left, event.clientY - box.top].map((place, side) => Math.floor((place - offset[side]) / zoom))
  return at[0] >= 0 && at[1] >= 0 && at[0] < width && at[1] < height ? at : null
}

const short = (value) => Number(value.toPrecision(4))
