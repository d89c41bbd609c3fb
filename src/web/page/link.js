// The program in two web workers: one paints and proves, and the other answers requests.

/// Compiles the module: a part of this file, or a file beside it.
const compiled = async () => {
  const inline = $('#module')
  if (!inline) return WebAssembly.compileStreaming(fetch('tabray.wasm'))
  const packed = Uint8Array.from(atob(inline.textContent), (letter) => letter.charCodeAt(0))
  return WebAssembly.compile(await through(packed, new DecompressionStream('gzip')))
}

const decoder = new TextDecoder()

/// An answer in the form of a server's.
const answerOf = (status, bytes) => ({
  ok: status === 200,
  status,
  text: async () => decoder.decode(bytes),
  json: async () => JSON.parse(decoder.decode(bytes)),
  arrayBuffer: async () => bytes,
})

// The time in milliseconds after which a worker that has not received a new scene is restarted.
const PATIENCE = 2000

/// Starts a worker; `hears` takes its messages that answer no request.
const start = (module, hears) => new Promise((ready) => {
  const source = URL.createObjectURL(new Blob([$('#worker').textContent], { type: 'text/javascript' }))
  const waiting = new Map()
  let worker = null, last = 0
  const ask = (path, body = '', paints = false) => new Promise((done) => {
    const request = { id: ++last, path, body, paints }
    // The worker is busy with an older scene, which is no longer wanted.
    waiting.set(last, { request, done, timer: paints ? setTimeout(anew, PATIENCE) : 0 })
    worker.postMessage(request)
  })
  ask.give = (name, bytes) => worker.postMessage({ file: name, bytes })
  ask.stop = () => worker.postMessage({ stop: true })
  const begin = () => {
    worker?.terminate()
    worker = new Worker(source)
    worker.onmessage = ({ data }) => {
      if (data.ready) return ready(ask)
      if (data.heard) return Object.assign(waiting.get(data.heard), { isHeard: true }), clearTimeout(waiting.get(data.heard).timer)
      if (!data.id) return hears(data)
      waiting.get(data.id).done(answerOf(data.status, data.bytes))
      waiting.delete(data.id)
    }
    worker.postMessage({ module })
    for (const [name, bytes] of kept) ask.give(name, bytes)
  }
  const anew = () => {
    const asked = [...waiting.values()]
    begin()
    hears({ late: true })
    for (const { request, done, timer, isHeard } of asked) {
      clearTimeout(timer)
      if (!isHeard) {
        worker.postMessage(request)
        continue
      }
      waiting.delete(request.id)
      done(answerOf(503, new TextEncoder().encode('{"lines":[],"report":"error: this took too long"}')))
    }
  }
  begin()
})

// The files that the scene may name, by their encoded names.
const kept = new Map()

let program = null, painter = null, helper = null

/// Gives a file to the program.
const give = (name, bytes) => {
  const part = encodeURIComponent(name)
  kept.set(part, bytes)
  for (const ask of [painter, helper, ...smoothers]) ask.give(part, bytes)
}

// The scene of the picture, and the version of the helper's scene.
let painted = { version: 0, text: '' }, helped = 0

/// Reads a text as a scene. If it is one, its picture follows.
let reads = 0
const read = async (text) => {
  const of = ++reads, answer = await painter(`scene/${of}`, text, true)
  if (!answer.ok) {
    if (of !== reads) return
    const { lines, report: words, lacking: names } = await answer.json()
    lack(names ?? [])
    refuse({ lines, report: words, name: nameOf(text), text: null })
    tellProof()
    // The editor shows faults that have a place in the text.
    if (lines.length) report('', false)
    return
  }
  painted = { version: of, text }
  const told = await answer.json()
  lack(told.lacking)
  begin({ ...told, warnings: '', version: of, text, name: nameOf(text) })
}

/// The name of a scene: the first words of a comment at its beginning.
const nameOf = (text) => text.match(/^#\s*([^:\n]{1,60})/)?.[1].trim() || 'scene'

/// Takes in a message of the painter.
const hear = (data) => {
  const counted = data.restarted ? 'restarts' : data.late ? 'late' : null
  if (counted) {
    root.dataset[counted] = 1 + +(root.dataset[counted] ?? 0)
    return
  }
  if (data.version !== `${version}`) return
  if (data.paint) {
    eachArea(data.paint, part)
    root.dataset.first ??= Math.round(performance.now())
  }
  else if (data.prove) prove(new Uint8Array(data.prove))
  else if (data.painted !== undefined) {
    finish({ version, seconds: data.painted })
    if (data.words) remark({ version, words: data.words })
  } else if (data.proven) proofsEnd()
  else if (data.ended) report(data.ended, false)
}

/// Takes in areas of a picture.
const eachArea = (buffer, take) => {
  for (let at = 0; at < buffer.byteLength;) {
    const [left, top, wide, high, block, isFinal, blocks] = new Uint32Array(buffer, at, 7)
    const given = new Float32Array(buffer, at + 28, 3 * blocks), bytes = new Uint8Array(buffer, at + 28 + 12 * blocks, 3 * blocks)
    take(left, top, wide, high, block, isFinal, given, bytes)
    at += 28 + 12 * blocks + 4 * Math.ceil(3 * blocks / 4)
  }
}

/// Sends a request to the program, in the form of one to a server.
const request = async (path, { body = '' } = {}) => {
  const [what, of, name] = path.split('/')
  if (what === 'layer' && name === 'proof') return answerOf(200, proofLayer().buffer)
  const whole = of === undefined && ['camera', 'move', 'turn', 'try'].includes(what) ? `${what}/${version}` : path
  if (whole.split('/')[1] === `${painted.version}` && helped !== painted.version) {
    helped = painted.version
    await helper(`scene/${helped}`, painted.text)
  }
  return helper(whole, body)
}

/// The program's answer in one of its forms, or null.
const ask = (path, form) => request(path).then((answer) => answer.ok ? answer[form]() : null).catch(() => null)

/// Changes the scene: the program writes the change into its text.
const post = async (path, body) => {
  const answer = await request(path, { body })
  if (!answer.ok) return answer
  const { text } = await answer.json()
  await (path === 'turn' ? setText : setNumbers)(text)
  return answerOf(200, new TextEncoder().encode(path === 'turn' ? 'turned into a look_at' : ''))
}

const follow = async () => {
  state('loading', 'loading')
  try {
    program = await compiled()
    ;[painter, helper] = await Promise.all([start(program, hear), start(program, (data) => { helped = 0; hear(data) })])
  } catch (error) {
    state('broken', 'not loaded')
    return report(`error: the program cannot be loaded: ${error.message}\nhelp: it needs a browser of 2023 or later`, false)
  }
  root.dataset.loaded = Math.round(performance.now())
  await listSurfaces()
  await setText(await (hosted ? hosted.first : textOfAddress()) ?? await (await helper('surface/barth-6')).text())
  tellMisled()
  // On this page, dragging moves the camera from the beginning.
  toggleSteering()
  stage.blur()
  root.dataset.ready = 1
  if ('serviceWorker' in navigator && location.protocol.startsWith('http') && !$('#module')) navigator.serviceWorker.register('offline.js').catch(() => {})
}
