// The proof of the pixels: the badge, and the map.

// A verdict for each pixel, from the top: 0 not yet, 1 proven, 2 tie, 3 no equation, 4 wrong.
let verdicts = new Uint8Array(0), judged = 0, tally = [0, 0, 0, 0, 0]
const COLOURS = [null, [168, 200, 176], [255, 170, 0], [160, 90, 255], [255, 0, 60]]

const prove = (more) => {
  verdicts.set(more, judged)
  judged += more.length
  for (const verdict of more) tally[verdict]++
  tellProof()
  if (layer === 'proof' && judged % 5000 < more.length) fetchLayer()
}

const proofsEnd = () => {
  root.dataset.proven = version
  tellProof()
  announce($('#badge').textContent)
  if (layer === 'proof') fetchLayer()
}

const tellProof = () => {
  const badge = $('#badge'), all = verdicts.length, [, proven, ties, open, wrong] = tally
  const number = (count) => count.toLocaleString('en')
  badge.hidden = !all || !textIsThePicture
  if (judged < all) {
    badge.dataset.proof = wrong ? 'wrong' : 'going'
    badge.textContent = judged ? `proving: ${Math.floor(100 * judged / all)} %` : 'not proven yet'
  } else if (proven === all) {
    badge.dataset.proof = 'proven'
    badge.textContent = `✓ proven: ${number(all)} pixels`
  } else {
    badge.dataset.proof = wrong ? 'wrong' : 'open'
    const rest = [[ties + open, 'undecided'], [wrong, 'wrong']].filter(([count]) => count).map(([count, word]) => `${number(count)} ${word}`)
    badge.textContent = `${number(proven)} of ${number(all)} proven, ${rest.join(', ')}`
  }
}

/// The map: bright colours of undecided and wrong pixels, and the picture faintly where a pixel is proven.
const proofLayer = () => {
  const bytes = new Uint8Array(3 * verdicts.length)
  for (let pixel = 0; pixel < verdicts.length; pixel++) {
    const verdict = verdicts[pixel], from = 3 * pixel
    const grey = levels ? (levels[from] + levels[from + 1] + levels[from + 2]) / 3 : 0
    for (let channel = 0; channel < 3; channel++) {
      bytes[from + channel] = verdict > 1 ? COLOURS[verdict][channel] : verdict ? 0.45 * grey + 0.5 * COLOURS[1][channel] : 0.3 * grey
    }
  }
  return bytes
}

on.scene.push(() => {
  verdicts = new Uint8Array(width * height)
  judged = 0
  tally = [0, 0, 0, 0, 0]
  tellProof()
})
$('#badge').addEventListener('click', () => choose(layer === 'proof' ? 'picture' : 'proof'))
on.drawn.push(() => { $('#legend').hidden = layer !== 'proof' })
