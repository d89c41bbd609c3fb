// The formula bar: the formula of the scene's surface, and named surfaces.

const bar = $('#formula')

const listSurfaces = async () => {
  const all = await (await helper('surfaces')).json()
  $('#surfaces').append(...all.map(({ name, title: words, about }) => {
    const option = new Option(words, name)
    option.title = about
    return option
  }))
}

/// Shows the formula of a text, unless the user is writing one.
const showFormula = async (text) => {
  const formula = await (await helper('formula', text)).json()
  if (document.activeElement === bar) return
  bar.value = formula ?? ''
  $('#refused').textContent = ''
}

let later = 0
const useFormula = async () => {
  clearTimeout(later)
  const answer = await helper('formula/change', JSON.stringify({ text: editor.value, formula: bar.value }))
  $('#refused').textContent = answer.ok ? '' : bar.value.trim() ? await answer.text() : ''
  if (!answer.ok) return
  await setText((await answer.json()).text)
  const fault = problems.find(({ severity }) => severity === 'error')
  $('#refused').textContent = fault ? fault.message.split('\n')[0] : ''
  if (!fault) refresh()
}

bar.addEventListener('input', () => {
  clearTimeout(later)
  later = setTimeout(useFormula, 250)
})
$('#bar').addEventListener('submit', (event) => {
  event.preventDefault()
  useFormula()
})
$('#surfaces').addEventListener('change', async (event) => {
  const { value } = event.target
  if (!value) return
  close()
  await setText(await (await helper(`surface/${value}`)).text())
  event.target.value = ''
  refresh()
})
