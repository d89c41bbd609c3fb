// The tabs beside the image: the scene's text, its plan, and more.

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

for (const tab of tabs) tab.addEventListener('click', () => selectTab(tab))
$('#tabs').addEventListener('keydown', (event) => {
  const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key]
  if (!way) return
  event.preventDefault()
  event.stopPropagation()
  nextTab(way)
})
on.scene.push(() => { if (openTab().id === 'tab-plan') fetchPlan() })
bindings.t = () => nextTab(1)
