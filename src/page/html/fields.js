// The values of an entity, and values to try.

/// The attributes with tried values that are not in the file yet, by object and attribute.
const tried = new Set()

/// The shown entity: its name and its index in the scene.
let shown = null

const key = ({ kind, name }) => `${kind} ${name}`
const parsed = (text) => text && JSON.parse(text)

/// Shows the values of the object at a pixel.
const fetchFields = async ([x, fromTop]) => {
  const of = version
  const object = await ask(`object/${of}/${x}/${height - 1 - fromTop}`, 'text').then(parsed)
  if (of !== version || mark?.[0] !== x || mark[1] !== fromTop) return
  announce(`pixel ${x} ${height - 1 - fromTop}: ${object ? key(object) : 'no object'}`)
  if (object) open(object, await list(of))
}

/// The entities that have values.
const list = (of) => request(`entities/${of}`).then((answer) => answer.ok ? answer.json() : []).catch(() => [])

/// Shows the current values of the entity again, or those of the camera.
const refresh = async () => {
  const of = version, all = await list(of)
  const wanted = all.find((one) => shown && key(one) === key(shown)) ?? shown ?? all[0]
  if (of !== version || !wanted) return
  const entity = await request(`entity/${of}/${wanted.order}`).then((answer) => answer.json()).catch(() => null)
  if (of === version && entity) open(entity, all)
}

const open = (entity, all) => {
  // A field keeps its values while the user changes it.
  if ($('#fields select').value === key(entity) && $('#fields form').contains(document.activeElement)) return
  shown = entity
  $('#fields').hidden = false
  $('aside').classList.add('explains')
  const select = $('#fields select')
  if (!all.some((one) => key(one) === key(entity))) all.push(entity)
  select.replaceChildren(...all.map((one) => new Option(visible(key(one)), key(one), false, key(one) === key(entity))))
  showFields(entity)
  // There is now less room for the text.
  reveal(marked)
}

const showFields = ({ name, attributes }) => {
  $('#fields form').replaceChildren(...attributes.flatMap((attribute) => {
    const { name: of, label: words, material, about, each, values, range, signs, whole, fixed } = attribute
    const boxes = [], sliders = []
    const send = (values) => tryOut(material ?? name, of, values)
    const pick = (picked) => {
      boxes.forEach((box, index) => { box.value = sliders[index].value = picked[index] })
      send(picked.map(String))
    }
    const isColour = each.join() === 'red,green,blue' && values.length === 3
    const picker = isColour ? colourPicker(material ? `${material} ${of}` : of, about, values, fixed, pick) : null
    if (material) return picker?.row ?? []
    const rows = values.flatMap((value, index) => {
      const label = document.createElement('label'), box = document.createElement('input')
      const which = values.length > 1 ? ` ${each[index] ?? 'xyz'[index] ?? index + 1}` : ''
      label.textContent = visible(words ?? of) + which
      label.title = box.title = about
      label.htmlFor = box.id = `field-${of}-${index}`
      if (fixed) {
        const words = document.createElement('span')
        words.className = 'fixed'
        words.textContent = visible(`${value} (${fixed})`)
        label.removeAttribute('for')
        return [label, words]
      }
      const slider = document.createElement('input'), number = +value
      const reach = Math.max(1, 2 * Math.abs(number))
      const any = isColour && number >= 0 ? 0 : -Infinity
      const least = { any, 'not negative': 0, positive: whole ? 1 : (number + reach) / 400 }[signs]
      const [low, high] = range && range[1] - range[0] < 1e4 ? range : [Math.max(number - reach, least), number + reach]
      Object.assign(slider, { type: 'range', min: low, max: high, step: whole ? 1 : (high - low) / 400, value, title: about })
      slider.setAttribute('aria-label', (words ?? of) + which)
      Object.assign(box, { type: 'number', step: whole ? 1 : 'any', value })
      box.dataset.of = `${name} ${of}`
      if (tried.has(box.dataset.of)) box.classList.add('tried')
      const change = (from, to) => () => {
        if (from.value === '' || Number.isNaN(+from.value)) return
        to.value = from === slider && !whole ? +(+from.value).toPrecision(4) : from.value
        for (const other of boxes) other.classList.add('tried')
        picker?.show(boxes.map((box) => box.value))
        send(boxes.map((box) => box.value))
      }
      slider.addEventListener('input', change(slider, box))
      box.addEventListener('input', change(box, slider))
      boxes.push(box)
      sliders.push(slider)
      return [label, slider, box]
    })
    return picker ? [...picker.row, ...rows] : rows
  }))
}

/// Makes the swatch of a colour, which picks another one. A colour brighter than white is shown with its brightest
/// channel at 1, and keeps its brightness.
const colourPicker = (of, about, values, fixed, pick) => {
  const label = document.createElement('label'), box = document.createElement('input')
  label.textContent = visible(of)
  label.htmlFor = box.id = `field-${of}-colour`
  Object.assign(box, { type: 'color', title: about, disabled: !!fixed })
  let most = 1
  const show = (values) => {
    most = Math.max(1, ...values.map(Number).filter(Number.isFinite))
    const digits = values.map((value) => Math.round(255 * toScreen(Math.min(Math.max(+value || 0, 0) / most, 1))))
    box.value = `#${digits.map((digit) => digit.toString(16).padStart(2, '0')).join('')}`
  }
  show(values)
  box.addEventListener('input', () => {
    const light = box.value.match(/[0-9a-f]{2}/g).map((digits) => most * toLight(parseInt(digits, 16) / 255))
    pick(light.map((channel) => +channel.toPrecision(4)))
  })
  return { row: [label, box], show }
}

// While the program is busy with earlier values, only the latest ones are kept.
let sending = false, wanted = null
const tryOut = async (name, attribute, values) => {
  tried.add(`${name} ${attribute}`)
  wanted = JSON.stringify({ name, attribute, values })
  if (sending) return
  sending = true
  while (wanted) {
    const body = wanted
    wanted = null
    await post('try', body)
  }
  sending = false
}

$('#values').addEventListener('click', refresh)
$('#fields select').addEventListener('change', (event) => {
  const [kind, ...name] = event.target.value.split(' ')
  shown = { kind, name: name.join(' ') }
  event.target.focus()
  refresh()
})
$('#fields form').addEventListener('submit', (event) => event.preventDefault())

const close = () => {
  if ($('aside').contains(document.activeElement) && document.activeElement !== $('#text')) stage.focus()
  mark = null
  shown = null
  $('#mark').hidden = $('#told').hidden = $('#fields').hidden = true
  $('aside').classList.remove('explains')
  markLines(null)
}

bindings.v = refresh
