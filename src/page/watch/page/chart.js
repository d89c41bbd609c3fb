// The chart of the scene.

const sayChart = (said) => { $('#chart span').textContent = said }

// The chart that is being measured: it ends when nobody waits for it.
let charting = null

const measure = async () => {
  if (charting) return charting.abort()
  if (!version) return
  const seconds = $('#chart input').value, of = version, bar = $('#chart progress'), button = $('#chart button')
  const mine = charting = new AbortController()
  bar.value = 0
  bar.hidden = false
  button.textContent = 'stop'
  sayChart('measuring')
  const watching = setInterval(async () => {
    const [done, all] = await request(`charting/${of}`).then((answer) => answer.json()).catch(() => [0, 0])
    if (charting === mine && all) bar.value = Math.min(1, done / all)
  }, 500)
  const answer = await request(`chart/${of}/${seconds}`, { signal: mine.signal }).catch(() => null)
  const body = await answer?.text().catch(() => null)
  clearInterval(watching)
  charting = null
  bar.hidden = true
  button.textContent = 'measure'
  if (mine.signal.aborted) {
    if (of === version) sayChart('stopped')
    return
  }
  if (answer?.status === 410) return sayChart('the scene has changed: measure again')
  if (answer?.status === 404) return sayChart('the time limit is a whole number of seconds, from 1 to 3600')
  if (!answer?.ok || !body) return sayChart(body?.trim() || 'tabray is not running')
  const { svg, words, is_whole: isWhole } = JSON.parse(body)
  const bytes = new TextEncoder().encode(svg)
  const image = $('#chart img')
  image.src = `data:image/svg+xml;base64,${btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(''))}`
  image.alt = 'the chart; the text below says what it shows'
  image.hidden = false
  $('#chart pre').textContent = words
  sayChart(isWhole ? 'measured' : 'there was not enough time for all of it')
  root.dataset.charted = of
}

$('#chart button').addEventListener('click', measure)
on.scene.push(() => {
  if (charting) sayChart('the scene has changed: measure again')
  else if (!$('#chart img').hidden) sayChart('of the scene before its last change')
  charting?.abort()
})
