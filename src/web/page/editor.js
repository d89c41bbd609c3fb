// The editor of the scene's text: errors, completion, and the meaning of words, as the language server has them.

const editor = $('#editor'), ground = $('#ground'), proposals = $('#proposals'), tip = $('#hint')

/// A text of several lines, with invisible characters shown as by `visible`.
const plain = (text) => text.split('\n').map(visible).join('\n')

// The errors and warnings of the text, each with its place.
let problems = []
// The lines of the explained object.
let marked = []

const lineAt = (line) => ground.children[line - 1]

/// Draws the lines and marks behind the text.
const drawGround = () => {
  const text = editor.value
  let at = 0
  ground.replaceChildren(...text.split('\n').map((line, index) => {
    const row = document.createElement('div'), end = at + line.length
    row.classList.toggle('marked', marked.length > 0 && index + 1 >= marked[0] && index + 1 <= marked[1])
    let from = at
    for (const { place: [first, last], severity } of problems) {
      if (last < from || first > end || (first === last && first < at)) continue
      const [start, stop] = [Math.max(first, from), Math.min(Math.max(last, first + 1), end)]
      row.append(...coloured(line, from - at, start - at))
      const mark = document.createElement('mark')
      mark.className = severity
      mark.append(...coloured(line, start - at, stop - at))
      if (start >= stop) mark.textContent = ' '
      row.append(mark)
      from = Math.max(from, stop)
    }
    row.append(...coloured(line, from - at))
    at = end + 1
    return row
  }))
  scrollGround()
}

/// Takes in the text of a scene, unless the user is writing.
const write = (text) => { if (editor.value !== text && document.activeElement !== editor) showText(text) }

const showText = (text) => {
  const { scrollTop, scrollLeft, selectionStart, selectionEnd } = editor
  editor.value = text
  editor.setSelectionRange(selectionStart, selectionEnd)
  Object.assign(editor, { scrollTop, scrollLeft })
  problems = []
  drawGround()
}

const markLines = (lines) => {
  marked = lines ?? []
  drawGround()
  if (lines) reveal(lines)
}
const markWrong = () => {}

const reveal = ([first] = []) => {
  const row = lineAt(first)
  if (!row || document.activeElement === editor) return
  const { offsetTop, offsetHeight } = row
  if (offsetTop < editor.scrollTop || offsetTop + offsetHeight > editor.scrollTop + editor.clientHeight) {
    editor.scrollTop = Math.max(0, offsetTop - editor.clientHeight / 3)
  }
  scrollGround()
}

/// Changes the text, and reads it.
const setText = async (text) => {
  if (editor.value !== text) showText(text)
  await changed()
}

/// Reads and examines the current text.
const changed = async () => {
  const text = editor.value, examined = examine(text)
  await read(text)
  await examined
}

/// Changes numbers of the text. The picture is rendered at once; the rest follows after a pause.
let rests = 0
const setNumbers = async (text) => {
  showText(text)
  clearTimeout(rests)
  rests = setTimeout(() => examine(editor.value), 300)
  await read(text)
}

/// Finds the faults of a text, and its formula.
const examine = async (text) => {
  const answer = await helper('diagnose', text)
  if (editor.value !== text) return
  problems = answer.ok ? await answer.json() : []
  if (editor.value !== text) return
  drawGround()
  listProblems()
  showFormula(text)
  root.dataset.diagnosed = text.length
}

const listProblems = () => {
  $('#problems').replaceChildren(...problems.slice(0, 50).map(({ message, line, severity, place, meant, marked: word }) => {
    const item = document.createElement('li'), button = document.createElement('button')
    item.className = severity
    button.textContent = `line ${line}: ${plain(message)}`
    button.addEventListener('click', () => {
      editor.focus()
      editor.setSelectionRange(...place)
    })
    item.append(button)
    if (meant && editor.value.slice(...place) === word) {
      const cure = document.createElement('button')
      cure.textContent = `write \`${meant}\``
      cure.addEventListener('click', () => {
        insert(place, meant)
        editor.focus()
      })
      item.append(cure)
    }
    return item
  }))
}

let soon = 0
const changeSoon = () => {
  clearTimeout(soon)
  soon = setTimeout(changed, 120)
}

/// Replaces a range, as a step that can be undone.
const insert = ([start, end], text) => {
  editor.focus()
  editor.setSelectionRange(start, end)
  if (!document.execCommand('insertText', false, text)) editor.setRangeText(text, start, end, 'end')
  problems = []
  drawGround()
  changeSoon()
}

// Completion.

let offered = [], chosen = 0, completes = 0

const closeProposals = () => {
  completes++
  proposals.hidden = true
  editor.removeAttribute('aria-activedescendant')
}

/// The place of a character on the editor's paper, in pixels.
const placeOf = (at) => {
  const before = editor.value.slice(0, at), line = before.split('\n').length - 1
  const column = before.length - before.lastIndexOf('\n') - 1, { left, top, wide, high } = metrics()
  return [left + column * wide - editor.scrollLeft, top + line * high - editor.scrollTop, high]
}

/// The sizes of the text's characters.
let measured = null
const metrics = () => {
  if (measured) return measured
  const style = getComputedStyle(editor), pen = document.createElement('canvas').getContext('2d')
  pen.font = style.font
  measured = { left: parseFloat(style.paddingLeft), top: parseFloat(style.paddingTop), wide: pen.measureText('0').width, high: parseFloat(style.lineHeight) }
  return measured
}

const put = (box, [left, top, high]) => {
  const paper = $('#paper')
  box.hidden = false
  const below = top + high + box.offsetHeight < paper.clientHeight || top < paper.clientHeight / 2
  box.style.left = `${Math.max(0, Math.min(left, paper.clientWidth - box.offsetWidth))}px`
  box.style.top = `${below ? top + high : Math.max(0, top - box.offsetHeight)}px`
}

const complete = async (isAsked) => {
  const at = editor.selectionStart, text = editor.value, mine = ++completes
  const all = await (await helper(`complete/${at}`, text)).json()
  if (mine !== completes || editor.value !== text) return
  const typed = ({ place }) => text.slice(place[0], at).toLowerCase()
  offered = all.filter((one) => one.label.toLowerCase().startsWith(typed(one))).slice(0, 40)
  const isOver = offered.length === 1 && typed(offered[0]) === offered[0].label.toLowerCase()
  if (!offered.length || isOver || (!isAsked && !typed(offered[0]))) return closeProposals()
  proposals.replaceChildren(...offered.map(({ label, detail, about }, index) => {
    const row = document.createElement('li'), more = document.createElement('span')
    Object.assign(row, { id: `proposal-${index}`, role: 'option', title: plain(about) })
    row.append(visible(label))
    more.textContent = detail
    row.append(more)
    row.addEventListener('pointerdown', (event) => {
      event.preventDefault()
      chosen = index
      accept()
    })
    return row
  }))
  put(proposals, placeOf(offered[0].place[0]))
  announce(offered.length === 1 ? '1 proposal' : `${offered.length} proposals`)
  pick(0)
}

const pick = (index) => {
  chosen = (index + offered.length) % offered.length
  ;[...proposals.children].forEach((row, at) => { row.ariaSelected = at === chosen })
  proposals.children[chosen].scrollIntoView({ block: 'nearest' })
  editor.setAttribute('aria-activedescendant', `proposal-${chosen}`)
}

/// Writes the chosen proposal, and selects the first place to be filled in.
const accept = () => {
  const { place, snippet, has_places: hasPlaces } = offered[chosen]
  let first = null, text = ''
  if (hasPlaces) {
    const parts = snippet.split(/\$\{\d+(?:[:|]((?:[^}\\]|\\.)*))?\}|\$\d/)
    parts.forEach((part, index) => {
      if (index % 2) {
        const word = (part ?? '').split(/[,|]/)[0]
        first ??= [text.length, text.length + word.length]
        text += word
      } else text += part.replace(/\\([$}\\])/g, '$1')
    })
  } else text = snippet
  closeProposals()
  insert([place[0], Math.max(place[1], editor.selectionStart)], text)
  if (first) editor.setSelectionRange(place[0] + first[0], place[0] + first[1])
}

// The meaning of words.

/// Shows text with a little Markdown.
const showHint = (words, place) => {
  tip.replaceChildren(...words.split(/(```[^]*?```|\*\*[^*]+\*\*|`[^`]+`)/).map((part) => {
    const fence = part.match(/^```\w*\n([^]*?)\n?```$/), bold = part.match(/^\*\*(.+)\*\*$/), code = part.match(/^`(.+)`$/)
    const element = document.createElement(bold ? 'b' : fence || code ? 'code' : 'span')
    element.textContent = plain((fence ?? bold ?? code)?.[1] ?? part)
    return element
  }))
  put(tip, place)
}
const closeHint = () => { tip.hidden = true }

const explainWord = async (at) => {
  const text = editor.value, found = await (await helper(`hover/${at}`, text)).json()
  if (editor.value !== text) return
  const faults = problems.filter(({ place: [start, end] }) => start <= at && at <= end).map(({ message }) => message)
  if (!found && !faults.length) return closeHint()
  showHint([...faults, found?.text].filter(Boolean).join('\n\n'), placeOf(found ? found.place[0] : at))
}

/// The character under the pointer.
const letterUnder = (event) => {
  const box = editor.getBoundingClientRect(), { left, top, wide, high } = metrics()
  const line = Math.floor((event.clientY - box.top + editor.scrollTop - top) / high)
  const column = Math.floor((event.clientX - box.left + editor.scrollLeft - left) / wide)
  const lines = editor.value.split('\n')
  if (line < 0 || line >= lines.length || column < 0 || column >= lines[line].length) return null
  return lines.slice(0, line).reduce((sum, text) => sum + text.length + 1, 0) + column
}

let hovers = 0
editor.addEventListener('pointermove', (event) => {
  clearTimeout(hovers)
  if (event.pointerType !== 'mouse' || event.buttons) return
  const at = letterUnder(event)
  hovers = setTimeout(() => at === null ? closeHint() : explainWord(at), 250)
})
editor.addEventListener('pointerleave', () => { clearTimeout(hovers); closeHint() })

/// Shows which value of the attribute is at the cursor.
let signs = 0
document.addEventListener('selectionchange', () => {
  if (document.activeElement !== editor || !helper) return
  clearTimeout(signs)
  signs = setTimeout(async () => {
    const found = await (await helper(`signature/${editor.selectionStart}`, editor.value)).json(), line = $('#values-hint')
    if (!found) return line.replaceChildren()
    const { label, values, active } = found, [start, end] = values[active] ?? [0, 0], strong = document.createElement('b')
    strong.textContent = label.slice(start, end)
    line.replaceChildren(label.slice(0, start), strong, label.slice(end))
  }, 80)
})

editor.addEventListener('input', (event) => {
  problems = []
  drawGround()
  closeHint()
  changeSoon()
  const before = editor.value[editor.selectionStart - 1] ?? ''
  if (event.inputType?.startsWith('insert') && /[\p{L}_]/u.test(before)) complete(false)
  else closeProposals()
})
editor.addEventListener('scroll', () => { scrollGround(); closeProposals(); closeHint() })
editor.addEventListener('blur', closeProposals)
// Escape lets the next Tab leave the text.
let leaves = false
editor.addEventListener('keydown', (event) => {
  const { key } = event, isOpen = !proposals.hidden
  const leftBefore = leaves
  leaves = false
  if (key === ' ' && event.ctrlKey) complete(true)
  else if (key === 'F1') explainWord(editor.selectionStart)
  else if (isOpen && key === 'ArrowDown') pick(chosen + 1)
  else if (isOpen && key === 'ArrowUp') pick(chosen - 1)
  else if (isOpen && (key === 'Enter' || key === 'Tab')) accept()
  else if (isOpen && key === 'Escape') closeProposals()
  else if (key === 'Escape') {
    leaves = true
    closeHint()
  } else if (key === 'Tab' && !event.shiftKey && !leftBefore) insert([editor.selectionStart, editor.selectionEnd], '    ')
  else return
  event.preventDefault()
})
new ResizeObserver(() => { measured = null; scrollGround() }).observe(editor)
