// What differs from the scene's file: values that are tried out, as the program tells them to all pages.

/// Shows which values differ from the file.
const differ = (all) => {
  tried.clear()
  for (const { name, attribute } of all) tried.add(`${name} ${attribute}`)
  for (const box of document.querySelectorAll('#fields input[type=number]')) {
    box.classList.toggle('tried', tried.has(box.dataset.of))
  }
  $('#differs').hidden = !all.length
  $('#differs span').textContent = all.length === 1 ? '1 value differs from the file' : `${all.length} values differ from the file`
  if (!all.length) $('#differs pre').hidden = true
  $('#differs ul').replaceChildren(...all.map(({ name, attribute, values, text }) => {
    // A named number has no object.
    const of = `${name} ${attribute}`.trim(), row = document.createElement('li'), words = document.createElement('span')
    words.textContent = `${of} ${text.join(' ') || '(not given)'} → ${values.join(' ')}`
    const buttons = ['write', 'discard'].map((verb) => {
      const button = document.createElement('button')
      button.textContent = verb
      button.setAttribute('aria-label', `${verb} ${of}`)
      button.addEventListener('click', () => settle(verb, { name, attribute }))
      return button
    })
    row.append(words, ...buttons)
    return row
  }))
}

/// Writes or discards what is tried out: of one attribute if it is given.
const settle = async (verb, one) => {
  await queue
  const answer = await post(verb, one ? JSON.stringify(one) : '')
  const said = answer ? (await answer.text()).trim() : 'tabray is not running'
  $('#fields p span').textContent = said.split('\n')[0]
  $('#differs pre').textContent = said
  $('#differs pre').hidden = !!answer?.ok
  if (answer?.ok) document.activeElement?.blur()
}
const [writeAll, discardAll] = document.querySelectorAll('#differs > button')
writeAll.addEventListener('click', () => settle('write'))
discardAll.addEventListener('click', () => settle('discard'))
$('#write').addEventListener('click', () => settle('write'))
$('#discard').addEventListener('click', () => settle('discard'))
