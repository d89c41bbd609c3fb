// The list of scenes. Each has a page of its own, at an address with its number.

const here = +(location.pathname.match(/^\/of\/(\d+)\//)?.[1] ?? 0)
let scenes = []

const goTo = (number, part = '') => { if (number !== here) location.assign(`/of/${number}/${token}${part}`) }

/// Goes to the next scene, or to the one before; the first one follows the last.
const goOn = (way) => {
  const at = scenes.findIndex(({ number }) => number === here)
  const from = at < 0 && way < 0 ? 0 : at
  if (scenes.length) goTo(scenes[(from + way + scenes.length) % scenes.length].number)
}

const listScenes = (all) => {
  const select = $('#scenes'), isFirst = !scenes.length
  scenes = all
  // The scene that is shown stays in the list when its file has gone.
  const gone = [...select.options].find(({ value }) => +value === here)?.text.replace(/ \(gone\)$/, '') ?? 'scene'
  const listed = all.some(({ number }) => number === here) ? all : [...all, { number: here, name: `${gone} (gone)` }]
  select.replaceChildren(...listed.map(({ number, name }) => new Option(name, number, false, number === here)))
  select.hidden = false
  if (isFirst && location.hash === '#scenes') select.focus()
}

$('#scenes').addEventListener('change', (event) => goTo(+event.target.value, '#scenes'))

bindings.n = () => goOn(1)
bindings.p = () => goOn(-1)
