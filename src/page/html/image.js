// The image and its layers.

// The bytes of the picture's pixels, if the program sends them with the colours.
let levels = null

const resize = ([wide, high]) => {
  if (wide === width && high === height) return
  ;[width, height] = [canvas.width, canvas.height] = [wide, high]
  colours = new Float32Array(3 * width * height)
  levels = null
  close()
  fit()
}

/// Stores an area of the picture: one colour for each block, with its bytes if there are any.
const part = (left, top, wide, high, block, isFinal, given, bytes) => {
  const across = Math.ceil(wide / block)
  if (bytes) levels ??= new Uint8Array(colours.length)
  for (let y = 0; y < high; y++) {
    for (let x = 0; x < wide; x++) {
      const from = 3 * (Math.floor(y / block) * across + Math.floor(x / block))
      const to = 3 * ((top + y) * width + left + x)
      colours[to] = given[from]
      colours[to + 1] = given[from + 1]
      colours[to + 2] = given[from + 2]
      for (let channel = 0; bytes && channel < 3; channel++) levels[to + channel] = bytes[from + channel]
    }
  }
  if (root.dataset.begun !== `${version}`) root.dataset.begun = version
  if (isFinal) {
    if (!ready) began = performance.now()
    ready += wide * high
  }
  if (root.dataset.state === 'rendering') state('rendering', `rendering, ${Math.floor(100 * ready / (width * height))} %${timeLeft()}`)
  if (layer === 'picture') expose(left, top, wide, high)
}

/// Returns the remaining time as text; empty until it can be estimated.
const timeLeft = () => {
  const took = (performance.now() - began) / 1000, part = ready / (width * height)
  if (!ready || took < 1) return ''
  return `, ${Math.ceil(took * (1 - part) / part)} s left`
}

/// Puts an area on the canvas, with the exposure.
const expose = (left, top, wide, high, from = colours, onto = paper) => {
  if (!wide || !high) return
  const image = new ImageData(wide, high), areThere = levels && from === colours && !stops
  for (let y = 0, to = 0; y < high; y++) {
    for (let at = 3 * ((top + y) * width + left), end = at + 3 * wide; at < end; at += 3) {
      for (const byte of areThere ? levels.subarray(at, at + 3) : bytesOf(from, at, stops)) image.data[to++] = byte
      image.data[to++] = 255
    }
  }
  onto.putImageData(image, left, top)
}

const fetchLayer = async () => {
  const of = version, name = layer
  waits = true
  tell()
  const answer = await ask(`layer/${of}/${name}`, 'arrayBuffer')
  // If the scene has changed meanwhile, the new one requests its layer again.
  if (!answer || of !== version || name !== layer) return
  const bytes = new Uint8Array(answer)
  const image = new ImageData(width, height)
  for (let from = 0, to = 0; from < bytes.length; from += 3, to += 4) {
    image.data.set([bytes[from], bytes[from + 1], bytes[from + 2], 255], to)
  }
  paper.putImageData(image, 0, 0)
  waits = false
  tell()
  root.dataset.layer = `${of} ${name}`
}

const choose = (name) => {
  layer = name
  $(`#layers [value=${name}]`).checked = true
  $('#exposure input').disabled = name !== 'picture'
  delete root.dataset.layer
  waits = false
  tell()
  happens('drawn')
  if (name === 'picture') expose(0, 0, width, height)
  else if (version) fetchLayer()
}

const setExposure = (value) => {
  const slider = $('#exposure input')
  slider.value = value
  stops = +slider.value
  $('#exposure output').textContent = stops > 0 ? `+${stops}` : stops
  happens('drawn')
  if (layer === 'picture') expose(0, 0, width, height)
}
