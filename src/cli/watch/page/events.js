// What the program tells.

// What lets this page ask anything: the query of its address.
const token = location.search

/// What the program answers, in one form or another, or nothing. Of each form the last answer alone is of interest: the
/// program need not work at the one before.
const asked = {}
const ask = (path, form) => {
  asked[form]?.abort()
  asked[form] = new AbortController()
  const answer = fetch(path + token, { signal: asked[form].signal })
  return answer.then((answer) => answer.ok ? answer[form]() : null).catch(() => null)
}

// The warnings about the scene.
let warnings = ''

const follow = () => {
  const events = new EventSource(`events${token}`)
  const on = (name, act) => events.addEventListener(name, (event) => act(event.data))
  on('scenes', (data) => listScenes(JSON.parse(data)))
  on('watching', (data) => {
    const refused = JSON.parse(data)
    $('#deaf').textContent = refused
    $('#deaf').hidden = !refused
  })
  on('tried', (data) => differ(JSON.parse(data)))
  on('scene', (data) => {
    const scene = JSON.parse(data)
    version = scene.version
    display = scene.display
    root.dataset.version = version
    ready = 0
    title(scene.name)
    resize(scene.size)
    textIsThePicture = true
    write(scene.text)
    warnings = scene.warnings
    report(warnings, true)
    state('rendering', 'rendering')
    compareNext()
    renewTab()
    if (mark && !drag?.gesture) explain(mark)
    if (shown) refresh()
    if (steers && !drag) learnCamera()
    if (layer !== 'picture') fetchLayer()
  })
  on('part', (data) => {
    const [of, left, top, wide, high, block, isFinal, base64] = data.split(' ')
    if (+of === version) part(+left, +top, +wide, +high, +block, +isFinal, numbers(base64))
  })
  on('done', (data) => {
    const { version: of, seconds } = JSON.parse(data)
    if (of !== version) return
    compare()
    if (root.dataset.state === 'rendering') state('done', `${width} × ${height}, ${seconds.toFixed(2)} s`)
    requestAnimationFrame(() => { root.dataset.shown = version; root.dataset.shownAt = Date.now() })
  })
  on('remark', (data) => {
    const { version: of, words } = JSON.parse(data)
    if (of === version) report([warnings, words].filter(Boolean).join('\n'), true)
  })
  on('fault', (data) => {
    const fault = JSON.parse(data)
    title(fault.name)
    textIsThePicture = false
    if (fault.text !== null) write(fault.text)
    for (const line of fault.lines) lineAt(line)?.classList.add('wrong')
    reveal(fault.lines.slice(0, 1))
    report(fault.report, false)
    state('broken', version ? 'the last good image' : 'no image yet')
  })
  events.onerror = async () => {
    state('lost', 'tabray is not running; waiting for it')
    // The browser tries again by itself, unless there was an answer that held no events.
    if (events.readyState !== EventSource.CLOSED) return
    const answer = await fetch(token).catch(() => null)
    if (answer?.status === 403) state('lost', 'tabray was started again: open the address that it printed')
    else setTimeout(follow, 500)
  }
}

const numbers = (base64) => {
  if (Uint8Array.fromBase64) return new Float32Array(Uint8Array.fromBase64(base64).buffer)
  const text = atob(base64), bytes = new Uint8Array(text.length)
  for (let at = 0; at < bytes.length; at++) bytes[at] = text.charCodeAt(at)
  return new Float32Array(bytes.buffer)
}

const title = (name) => { $('#name').textContent = name; document.title = `${name} – tabray` }

const report = (words, warns) => {
  const box = $('#report')
  box.textContent = words
  box.hidden = !words
  box.classList.toggle('warns', warns)
}
