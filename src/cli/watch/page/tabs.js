// The tabs beside the image: the scene's text, its plan, and its chart.

const tabs = [...document.querySelectorAll('#tabs button')]
const openTab = () => tabs.find((tab) => tab.ariaSelected === 'true')

const selectTab = (tab) => {
  for (const one of tabs) {
    one.ariaSelected = one === tab
    $(`#${one.getAttribute('aria-controls')}`).hidden = one !== tab
  }
  if (tab.id === 'tab-plan') fetchPlan()
}

const nextTab = (way) => {
  const tab = tabs[(tabs.indexOf(openTab()) + way + tabs.length) % tabs.length]
  selectTab(tab)
  if (tabs.includes(document.activeElement)) tab.focus()
}

/// Follows a change of the scene.
const renewTab = () => {
  if (openTab().id === 'tab-plan') fetchPlan()
  if (charting) sayChart('the scene has changed: measure again')
  else if (!$('#chart img').hidden) sayChart('of the scene before its last change')
  charting?.abort()
}

const fetchPlan = async () => {
  const of = version
  if (!of) return
  const words = await ask(`plan/${of}`, 'text')
  if (words === null || of !== version) return
  $('#plan').replaceChildren(...words.split(/(?<=\n)/).map((decision) => {
    const row = document.createElement('div')
    row.textContent = decision
    return row
  }))
  root.dataset.plan = of
}

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
    const [done, all] = await fetch(`charting/${of}${token}`).then((answer) => answer.json()).catch(() => [0, 0])
    if (charting === mine && all) bar.value = Math.min(1, done / all)
  }, 500)
  const answer = await fetch(`chart/${of}/${seconds}${token}`, { signal: mine.signal }).catch(() => null)
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

for (const tab of tabs) tab.addEventListener('click', () => selectTab(tab))
$('#tabs').addEventListener('keydown', (event) => {
  const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key]
  if (!way) return
  event.preventDefault()
  event.stopPropagation()
  nextTab(way)
})
$('#chart button').addEventListener('click', measure)
