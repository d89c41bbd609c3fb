// One of two web workers. The program answers requests, paints a picture in steps, and then proves its pixels.
'use strict'

// The minimum time in milliseconds that the program works before the worker receives the next message.
const TURN = 30

let module = null, program = null
// The picture in work: its version, the kind of work ('paint' or 'prove'), and the amount of one turn.
let job = null

const coder = new TextEncoder(), decoder = new TextDecoder()

// The files that the scene may name, by their encoded names.
const held = new Map()

const begin = () => {
  program = new WebAssembly.Instance(module, {}).exports
  program.start()
  for (const [name, bytes] of held) ask(`file/${name}`, bytes)
}

/// Asks the program, and returns its status and its bytes.
const ask = (path, body = '') => {
  const [head, tail] = [path, body].map((part) => typeof part === 'string' ? coder.encode(part) : part)
  const length = head.length + tail.length, at = program.room(length)
  const request = new Uint8Array(program.memory.buffer, at, length)
  request.set(head)
  request.set(tail, head.length)
  const found = program.answer(at, head.length, length)
  const [status, size] = new Uint32Array(program.memory.buffer.slice(found, found + 8))
  const bytes = program.memory.buffer.slice(found + 8, found + 8 + size)
  program.free(found, size + 8)
  return { status, bytes }
}

/// Asks the program. If the program ends with an error, starts it again.
const askSafely = (path, body) => {
  try {
    return ask(path, body)
  } catch (error) {
    job = null
    begin()
    postMessage({ restarted: true })
    const report = `error: the program ended on this scene, and was started again\nhelp: ${error instanceof RangeError
      ? 'its reflections are deeper than a browser allows: use the program itself'
      : 'it may need more memory than a browser gives; if not, please report it'}`
    return /^(scene|smooth)\//.test(path)
      ? { status: 422, bytes: coder.encode(JSON.stringify({ lines: [], report, lacking: [] })).buffer }
      : { status: 500, bytes: coder.encode(report).buffer }
  }
}

const { port1, port2 } = new MessageChannel()
const goOn = () => port2.postMessage(null)

const end = (version, bytes) => {
  job = null
  postMessage({ version, ended: decoder.decode(bytes) })
}

port1.onmessage = () => {
  if (!job) return
  const { version, what, count } = job, before = performance.now()
  const { status, bytes } = askSafely(`${what}/${version}/${count}`)
  const took = performance.now() - before
  if (status !== 200) return end(version, bytes)
  // Each turn makes the plan again, so it must be long enough for more than that.
  if (!count) return Object.assign(job, { turn: Math.max(TURN, 4 * took), count: 4 }), goOn()
  if (took < job.turn / 2) job.count = 2 * count
  else if (took > 2 * job.turn) job.count = Math.max(1, count >> 1)
  if (bytes.byteLength) {
    postMessage({ version, [what]: bytes }, [bytes])
    return goOn()
  }
  if (what === 'prove') {
    job = null
    return postMessage({ version, proven: true })
  }
  const { began, proves } = job
  if (!proves) {
    job = null
    return postMessage({ version, painted: (performance.now() - began) / 1000 })
  }
  const told = askSafely(`painted/${version}`)
  if (told.status !== 200) return end(version, told.bytes)
  const { words } = JSON.parse(decoder.decode(told.bytes))
  postMessage({ version, painted: (performance.now() - began) / 1000, words })
  job = { ...job, what: 'prove', count: 64 }
  goOn()
}

onmessage = ({ data }) => {
  if (data.module) {
    module = data.module
    begin()
    return postMessage({ ready: true })
  }
  if (data.stop) {
    job = null
    return
  }
  if (data.file) {
    if (askSafely(`file/${data.file}`, data.bytes).status === 200) held.set(data.file, data.bytes)
    return
  }
  const { id, path, body, paints } = data
  postMessage({ heard: id })
  if (path === 'memory') return postMessage({ id, status: 200, bytes: coder.encode(`${program.memory.buffer.byteLength}`).buffer })
  const { status, bytes } = askSafely(path, body)
  postMessage({ id, status, bytes }, [bytes])
  if (!paints || status !== 200) return
  const goes = job
  const [what, version] = path.split('/')
  job = { version, what: 'paint', proves: what === 'scene', count: 0, turn: TURN, began: performance.now() }
  if (!goes) goOn()
}
