// The page for browsers and that of `tabray watch`, in Chromium: node tests/web/run.mjs WEB PROGRAM [AXE]
//
// WEB is what `cargo run -p tabray-web-build` made, PROGRAM is tabray itself, and AXE the script of axe-core. Screenshots are
// written to WEB/shots. TABRAY_EDITS is the number of random edits, by default 600.

import assert from 'node:assert/strict'
import { execFileSync, spawn } from 'node:child_process'
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { createServer } from 'node:http'
import { tmpdir } from 'node:os'
import { dirname, extname, join, resolve } from 'node:path'
import { fileURLToPath, pathToFileURL } from 'node:url'

const [web, program, axe] = process.argv.slice(2).map((path) => resolve(path))
const sources = join(dirname(fileURLToPath(import.meta.url)), '../..')
const edits = +(process.env.TABRAY_EDITS ?? 600)
const shots = join(web, 'shots'), work = mkdtempSync(join(tmpdir(), 'tabray-web-'))
mkdirSync(shots, { recursive: true })

// A server of files, and nothing else.
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm', '.svg': 'image/svg+xml', '.webmanifest': 'application/manifest+json' }
const server = createServer((request, answer) => {
  const path = new URL(request.url, 'http://x').pathname, file = join(web, path === '/' ? 'index.html' : path)
  if (!existsSync(file)) return answer.writeHead(404).end()
  // Such a page may measure its memory, that of its workers included.
  const alone = { 'cross-origin-opener-policy': 'same-origin', 'cross-origin-embedder-policy': 'require-corp' }
  answer.writeHead(200, { 'content-type': TYPES[extname(file)] ?? 'application/octet-stream', ...alone }).end(readFileSync(file))
})
await new Promise((done) => server.listen(0, '127.0.0.1', done))
const served = `http://127.0.0.1:${server.address().port}/`

// A browser, driven over WebDriver (W3C).
const driver = spawn('chromedriver', ['--port=0'], { stdio: ['ignore', 'pipe', 'ignore'] })
const port = await new Promise((done) => {
  let said = ''
  driver.stdout.on('data', (bytes) => {
    said += bytes
    const found = said.match(/started successfully on port (\d+)/)
    if (found) done(found[1])
  })
})
let session = `http://127.0.0.1:${port}/session`
const send = async (path, body, method = 'POST') => {
  const answer = await fetch(session + path, { method, body: body && JSON.stringify(body) })
  const { value } = await answer.json()
  assert(answer.ok, JSON.stringify(value))
  return value
}
const args = ['--headless=new', '--no-sandbox', '--disable-dev-shm-usage', '--window-size=1360,850', '--allow-file-access-from-files=false', '--enable-blink-features=ForceEagerMeasureMemory']
const capabilities = { alwaysMatch: { browserName: 'chrome', timeouts: { script: 3600000 }, 'goog:chromeOptions': { args, binary: process.env.CHROMIUM ?? '/usr/bin/chromium' }, 'goog:loggingPrefs': { browser: 'ALL' } } }
session += `/${(await send('', { capabilities })).sessionId}`

const go = (url) => send('/url', { url })
const run = (script, ...args) => send('/execute/sync', { script, args })
const until = (script, ...args) => send('/execute/async', { script: `const done = arguments[arguments.length - 1]; ${script}`, args })
const command = (cmd, params) => send('/goog/cdp/execute', { cmd, params })
const pause = (time) => new Promise((done) => setTimeout(done, time))
const wait = async (condition, most = 120) => {
  const start = Date.now()
  while (!await run(`return !!(${condition})`)) {
    assert(Date.now() - start < 1000 * most, `waited for ${condition}: ${await run('return document.body.innerText')}`)
    await pause(20)
  }
}
const shot = async (name) => writeFileSync(join(shots, `${name}.png`), Buffer.from(await send('/screenshot', null, 'GET'), 'base64'))
const screen = (width, height, mobile, scheme) => Promise.all([
  command('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile }),
  command('Emulation.setTouchEmulationEnabled', { enabled: mobile }),
  command('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: scheme }] }),
])
const data = (name) => run(`return document.documentElement.dataset[${JSON.stringify(name)}]`)
const isShown = "document.documentElement.dataset.shown === String(version) && editor.value === painted.text"

/// Shows a scene, and waits for the whole picture.
const show = async (text) => {
  const before = await run('return version')
  await until('setText(arguments[0]).then(done)', text)
  await wait(`version > ${before} && ${isShown}`)
}

/// The scene of a surface that has a name. Only the page for browsers knows it.
const surfaces = new Map()
const surface = async (name) => {
  if (!surfaces.has(name)) {
    surfaces.set(name, await until('helper(`surface/${arguments[0]}`).then((answer) => answer.text()).then(done)', name))
  }
  return surfaces.get(name)
}

/// The bytes of the picture on a canvas: that of the scene's pixels, or the one above it.
const canvas = async (which = 'canvas') => Buffer.from(await run(`
  const c = document.querySelector(arguments[0]), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data
  let s = ''
  for (let at = 0; at < d.length; at += 4) s += String.fromCharCode(d[at], d[at + 1], d[at + 2])
  return btoa(s)`, which), 'base64')

/// The bytes that the program renders.
const native = (text, ...options) => {
  const [scene, image] = ['scene.ray', 'image.ppm'].map((name) => join(work, name))
  writeFileSync(scene, text)
  execFileSync(program, ['render', scene, '-o', image, '--force', ...options], { stdio: ['ignore', 'ignore', 'pipe'] })
  const bytes = readFileSync(image)
  return bytes.subarray(bytes.indexOf('\n') + 1)
}

const step = async (title, work) => {
  const start = Date.now(), said = await work()
  console.log(`${title}: ${said ?? 'ok'} (${((Date.now() - start) / 1000).toFixed(1)} s)`)
}

const accessible = async (what) => {
  await run(readFileSync(axe, 'utf8'))
  const found = await until("axe.run(document, { resultTypes: ['violations'] }).then(({ violations }) => done(violations.map(({ id, impact, nodes }) => [id, impact, nodes.map((node) => node.target.join(' ') + ': ' + node.failureSummary)])))")
  const serious = found.filter(([, impact]) => ['serious', 'critical'].includes(impact))
  assert.deepEqual(serious, [], what)
  return found.map(([id]) => id)
}

// Each page: how it gets a scene, where it shows values that were changed, what it shows of one of them, whether the picture
// is whole, the text that it then has, and by how many levels bytes may differ from the program's.
const own = {
  of: 'the page for browsers', shots: '', show, changes: 'editor.value', changed: 'let w 1.2', isShown,
  text: () => run('return editor.value'), error: 0,
}
const file = join(work, 'watched.ray')
const watched = {
  of: 'the page of watch', shots: 'watch-', changes: "document.querySelector('#differs ul').textContent", changed: 'w 1 → 1.2',
  isShown: 'document.documentElement.dataset.shown === String(version)',
  show: async (text) => {
    const before = await run('return version')
    writeFileSync(file, text)
    await wait(`version > ${before} && ${watched.isShown}`)
  },
  text: async () => {
    await run("document.querySelector('#differs > button').click()")
    await wait(`document.querySelector('#differs').hidden && ${watched.isShown}`)
    return readFileSync(file, 'utf8')
  },
  // It is sent light in 32-bit numbers, not bytes.
  error: 1,
}

/// What both pages can do, with Barth's sextic in them.
const both = async ({ of, shots, show, changes, changed, isShown, text, error }) => {
  await step(`${of}: a pixel is explained, the plan is there, and a slider changes the text`, async () => {
    await run('look([200, 150])')
    await wait("document.querySelector('#told pre').textContent.includes('surface')")
    await run("selectTab(document.querySelector('#tab-plan'))")
    await wait("document.querySelector('#plan').textContent.includes('mirrors')")
    await shot(`${shots}explained`)
    await run("selectTab(document.querySelector('#tab-text')); close(); refresh()")
    await wait("document.querySelector('#field-w-0')")
    await run("const box = document.querySelector('#field-w-0'); box.value = 1.2; box.dispatchEvent(new Event('input'))")
    await wait(`${changes}.includes('${changed}') && ${isShown}`)
  })

  await step(`${of}: the camera orbits by dragging, and by keys`, async () => {
    const before = await run(`if (!steers) toggleSteering(); return ${changes}`)
    const box = await run("const b = stage.getBoundingClientRect(); return [b.left + b.width / 2, b.top + b.height / 2].map(Math.round)")
    const move = (x, y) => ({ type: 'pointerMove', x, y, duration: 20 })
    await send('/actions', { actions: [{ type: 'pointer', id: 'mouse', actions: [move(...box), { type: 'pointerDown', button: 0 }, move(box[0] + 60, box[1]), move(box[0] + 120, box[1] + 20), { type: 'pointerUp', button: 0 }] }] })
    await wait(`${changes} !== ${JSON.stringify(before)} && ${isShown}`)
    const dragged = await run(`stage.focus(); return ${changes}`)
    await send('/actions', { actions: [{ type: 'key', id: 'keys', actions: [{ type: 'keyDown', value: '\ue012' }, { type: 'keyUp', value: '\ue012' }] }] })
    await wait(`${changes} !== ${JSON.stringify(dragged)} && ${isShown}`)
    const [seen, right] = [await canvas(), native(await text())]
    assert(seen.every((byte, index) => Math.abs(byte - right[index]) <= error), 'other bytes than the program writes')
  })

  await step(`${of}: the image is pinned, and compared with the next`, async () => {
    await show(await surface('heart'))
    await run("document.querySelector('#compare').click()")
    await wait("document.querySelector('#comparing span').textContent.startsWith('none of')")
    await show(await surface('cayley'))
    await wait("document.querySelector('#comparing span').textContent.includes('differ')")
    const said = await run("return document.querySelector('#comparing span').textContent")
    await shot(`${shots}compared`)
    await run("document.querySelector('#compare').click()")
    return said
  })

  if (axe) await step(`${of}: axe-core finds nothing serious`, async () => {
    const minor = new Set()
    for (const [width, height, mobile, scheme] of [[1360, 850, false, 'light'], [1360, 850, false, 'dark'], [390, 844, true, 'light'], [390, 844, true, 'dark']]) {
      await screen(width, height, mobile, scheme)
      await run("refresh(); look([200, 150])")
      await pause(500)
      for (const id of await accessible(`${width} x ${height}, ${scheme}`)) minor.add(id)
    }
    return minor.size ? `minor: ${[...minor].join(', ')}` : 'nothing at all'
  })
  else console.log('SKIPPED: axe-core is not here')

  await step(`${of}: a phone and the dark`, async () => {
    await screen(390, 844, true, 'light')
    await run('close(); fit(); scrollTo(0, 0)')
    assert(await run('return document.documentElement.scrollWidth <= innerWidth'), 'wider than a phone')
    await pause(300)
    await shot(`${shots}phone`)
    await screen(1360, 850, false, 'dark')
    await run('fit(); refresh()')
    await pause(300)
    await shot(`${shots}dark`)
    await screen(1360, 850, false, 'light')
  })
}

try {
  await screen(1360, 850, false, 'light')
  await step('the first image of Barth’s sextic, 400 x 300', async () => {
    await go(`${served}#surface=barth-6`)
    await wait(isShown)
    const [loaded, first, shown] = await run(`
      const { loaded, first, shownAt } = document.documentElement.dataset
      return [+loaded, +first, shownAt - performance.timeOrigin]`)
    assert(first - loaded < 1000, `${first - loaded} ms`)
    return `loaded ${Math.round(loaded)} ms after the address, coarse ${Math.round(first - loaded)} ms after that, all ${Math.round(shown - loaded)} ms`
  })
  await shot('start')

  await step('ten scenes have the bytes of the program', async () => {
    const names = ['barth-6', 'clebsch', 'heart', 'goursat', 'gyroid', 'torus', 'kummer', 'superquadric']
    const texts = await Promise.all(names.map(surface))
    for (const file of ['scenes/entities/revsurf.ray', 'scenes/heart/glass.ray', 'scenes/gallery/marbles.ray', 'scenes/light/shadow.ray']) {
      texts.push(readFileSync(join(sources, file), 'utf8').replace(/pixeldim +\d+ +\d+/, 'pixeldim 96 72'))
    }
    for (const [index, text] of texts.entries()) {
      await show(text)
      assert((await canvas()).equals(native(text)), `scene ${index}`)
    }
    return `${texts.length} scenes`
  })

  await step('proofs', async () => {
    await show((await surface('goursat')).replace('400 300', '160 120'))
    await wait("document.documentElement.dataset.proven === String(version)", 300)
    assert.equal(await run("return document.querySelector('#badge').textContent"), '✓ proven: 19,200 pixels')
    await go(`${served}#surface=barth-6`)
    await send('/refresh', {})
    await wait("document.documentElement.dataset.proven === String(version)", 600)
    const words = await run("return document.querySelector('#badge').textContent")
    await run("if (document.querySelector('#fields').hidden) refresh()")
    await pause(300)
    await shot('surface')
    await run("document.querySelector('#badge').click()")
    await pause(500)
    await shot('proof')
    await run("choose('picture')")
    return words
  })

  await both(own)

  await step('at rest, the picture has the pixels of the screen and smooth edges', async () => {
    const text = await surface('heart')
    await show(text)
    await wait('document.documentElement.dataset.smooth')
    const [width, height, box] = await run("const c = document.querySelector('#fine'), b = c.getBoundingClientRect(); return [c.width, c.height, [b.width, b.height]]")
    assert(Math.abs(box[0] - width) <= 1 && Math.abs(box[1] - height) <= 1, `${width} x ${height} pixels on ${box}`)
    const size = ['--size', `${width}x${height}`], seen = await canvas('#fine')
    const [single, many] = [native(text, ...size), native(text, ...size, '--samples', '16')]
    let edges = 0
    for (let y = 0; y < height; y++) {
      for (let x = 0; x < width; x++) {
        const at = 3 * (y * width + x), pixel = (bytes) => bytes.subarray(at, at + 3)
        const differs = ([right, down]) => {
          const isThere = x + right >= 0 && x + right < width && y + down >= 0 && y + down < height
          return isThere && [0, 1, 2].some((channel) => Math.abs(single[at + channel] - single[at + channel + 3 * (right + down * width)]) > 8)
        }
        const isEdge = [[-1, 0], [1, 0], [0, -1], [0, 1]].some(differs)
        if (isEdge) edges++
        assert(pixel(seen).equals(pixel(isEdge ? many : single)), `${x} ${y}`)
      }
    }
    await shot('smooth')
    return `${width} x ${height}, ${(100 * edges / (width * height)).toFixed(1)} % with 16 samples, ${await data('smooth')} ms from the beginning`
  })

  await step('from a move of the camera to its coarse picture', async () => {
    await show(await surface('barth-6'))
    const times = await until(`
      const times = [], root = document.documentElement
      if (!steers) toggleSteering()
      const move = () => {
        const before = root.dataset.begun, from = performance.now()
        push('orbit', [7, 3], 1)
        const look = () => {
          if (root.dataset.begun === before) return requestAnimationFrame(look)
          times.push(performance.now() - from)
          if (times.length < 20) setTimeout(move, 50); else done(times.sort((a, b) => a - b).map(Math.round))
        }
        look()
      }
      move()`)
    return `median ${times[10]} ms, worst ${times[19]} ms`
  })

  await step('the formula bar draws what is typed', async () => {
    const type = (formula) => run("const bar = document.querySelector('#formula'); bar.value = arguments[0]; bar.dispatchEvent(new Event('input'))", formula)
    await show(await surface('barth-6'))
    await run('close()')
    await type('x^2 + y^2 + bend*z^2 = 1')
    await wait(`editor.value.includes('let bend 1') && ${isShown}`)
    assert(!/let [Pw]|Barth/.test(await run('return editor.value')), 'what Barth’s sextic needed')
    assert.equal(await run("return document.querySelector('h1').textContent"), 'a surface by its formula')
    await wait("document.querySelector('#field-bend-0') && !document.querySelector('#field-w-0')")
    await type('x^2 + y^2 + (z')
    await wait("document.querySelector('#badge').hidden")
    await pause(1000)
    assert(await run("return document.querySelector('#badge').hidden"), 'a proof of a picture that is not of the text')
    await run("const bar = document.querySelector('#formula'); bar.focus(); bar.value = 'x^2 + '; bar.dispatchEvent(new Event('input'))")
    await wait("document.querySelector('#refused').textContent.length > 0")
    const said = await run("return document.querySelector('#refused').textContent")
    await run('document.activeElement.blur()')
    return said
  })

  await step('errors are marked while they are typed, and words are completed', async () => {
    const text = await surface('torus')
    await show(text)
    await run("const at = editor.value.indexOf('direction'); editor.focus(); editor.setSelectionRange(at, at + 9); document.execCommand('insertText', false, 'dircetion')")
    await wait("document.querySelector('#problems li')")
    const said = await run("return document.querySelector('#problems li').textContent")
    assert(said.includes('did you mean `direction`'), said)
    await run("const at = editor.value.indexOf('material front  shader'); editor.setSelectionRange(at, at); document.execCommand('insertText', false, 'ca')")
    await wait("!document.querySelector('#proposals').hidden")
    assert((await run("return document.querySelector('#proposals').textContent")).includes('capped'))
    await shot('error')
    await run("editor.dispatchEvent(new KeyboardEvent('keydown', { key: 'Enter' }))")
    await wait("editor.value.includes('capped')")
    return said
  })

  await step('an address that asks for no known surface says so', async () => {
    await run("location.hash = '#surface=barth-66'")
    await wait("document.querySelector('#report').textContent.includes('there is no surface `barth-66`: did you mean `barth-6`?')")
    await go('about:blank')
    await go(`${served}#surface=teapot`)
    await wait(`document.documentElement.dataset.ready && ${isShown}`)
    const said = await run("return document.querySelector('#report').textContent")
    assert(said.includes('there is no surface `teapot`'), said)
    return said
  })

  await step('a text has colours, and stands where it is written', async () => {
    await show('# a ball\nlet k 1\n' + await surface('torus'))
    const [ground, text, kinds] = await run("return [[...ground.children].map((row) => row.textContent).join('\\n'), editor.value, [...new Set([...ground.querySelectorAll('span')].map((piece) => piece.className))].sort().join()]")
    assert.equal(ground, text)
    assert.equal(kinds, 'comment,keyword,number,quoted,type')
  })

  await step('a file under the name of another asks', async () => {
    const drop = (text) => run(`
      delete document.documentElement.dataset.kept
      const given = new DataTransfer()
      given.items.add(new File([arguments[0]], 'one.txt'))
      document.dispatchEvent(new DragEvent('drop', { dataTransfer: given, cancelable: true }))`, text)
    const kept = () => run("return new TextDecoder().decode(kept.get('one.txt'))")
    // The scene is read again before the page says so.
    const taken = () => wait('document.documentElement.dataset.kept')
    await drop('one')
    await taken()
    await drop('one')
    await taken()
    for (const [answer, text] of [['dismiss', 'one'], ['accept', 'two']]) {
      await drop('two')
      for (let tries = 0; tries < 50 && !await send('/alert/text', null, 'GET').catch(() => null); tries++) await pause(20)
      assert((await send('/alert/text', null, 'GET')).includes('another file with the name one.txt'))
      await send(`/alert/${answer}`, {})
      await taken()
      assert.equal(await kept(), text)
    }
    return kept()
  })

  await step('files that a scene names are dropped onto the page, or chosen', async () => {
    for (const [scene, names] of [['entities/texplane', ['textures/bricks.png']], ['entities/mesh', ['models/knot.obj', 'models/icosahedron.ply', 'models/bowl.stl']]]) {
      const file = join(sources, 'scenes', `${scene}.ray`), text = readFileSync(file, 'utf8').replace(/samples +\d+/, '')
      await until('setText(arguments[0]).then(done)', text)
      assert(names.every((name) => text.includes(name)) && await data('lacking'))
      const before = await run('return version'), paths = names.map((name) => join(sources, 'scenes', name))
      if (names.length > 1) {
        const box = Object.values(await send('/element', { using: 'css selector', value: '#chosen' }))[0]
        await send(`/element/${box}/value`, { text: paths.join('\n') })
      } else {
        await run(`
          const bytes = Uint8Array.from(atob(arguments[1]), (letter) => letter.charCodeAt(0)), given = new DataTransfer()
          given.items.add(new File([bytes], arguments[0]))
          document.dispatchEvent(new DragEvent('drop', { dataTransfer: given, cancelable: true }))`, names[0].split('/')[1], readFileSync(paths[0]).toString('base64'))
      }
      await wait(`version > ${before} && ${isShown}`)
      assert.equal(await data('lacking'), '')
      assert((await canvas()).equals(native(text.replaceAll('../', `${join(sources, 'scenes')}/`))), scene)
    }
    await run(`
      const given = new DataTransfer()
      given.items.add(new File(['# dropped\\n' + arguments[0]], 'a.ray'))
      document.dispatchEvent(new DragEvent('drop', { dataTransfer: given, cancelable: true }))`, await surface('torus'))
    await wait(`editor.value.startsWith('# dropped') && ${isShown}`)
  })

  await step('a worker that is busy with an older scene is given up', async () => {
    const busy = "look_at eye { pixeldim 64 64  position 3 2 4  target 0 0 0  angle 36  samples 65536 }"
    const heavy = (await surface('barth-10')).replace(/look_at eye [^\n]*/, busy)
    const late = +(await data('late') ?? 0)
    await until('setText(arguments[0]).then(done)', heavy)
    await wait("document.documentElement.dataset.begun === String(version)")
    // It paints coarsely first.
    await pause(1500)
    const start = Date.now(), text = await surface('heart')
    await show(text)
    const took = Date.now() - start
    assert.equal(+await data('late'), late + 1)
    assert((await canvas()).equals(native(text)))
    // The worker that took its place has the files, too.
    await show(readFileSync(join(sources, 'scenes/entities/texplane.ray'), 'utf8').replace(/samples +\d+/, ''))
    return `the next picture is there after ${took} ms`
  })

  await step('the address has the scene', async () => {
    await show(await surface('cayley'))
    await wait("location.hash.startsWith('#scene=') && location.hash === own")
    await pause(600)
    const [text, address] = await run('return [editor.value, location.href]')
    await go('about:blank')
    await go(address)
    await wait("document.documentElement.dataset.ready")
    assert.equal(await run('return editor.value'), text)
    return `${address.length} characters`
  })

  await step('files', async () => {
    await wait(isShown)
    const said = []
    for (const kind of ['png', 'exr', 'stl', 'ray']) {
      await run("document.querySelector('#files').open = true")
      if (kind === 'stl') await wait("document.querySelector('#files select').value")
      await run(`document.querySelector('[data-file=${kind}]').click()`)
      await wait(`(document.documentElement.dataset.saved ?? '').startsWith('${kind} ')`, 300)
      said.push(await data('saved'))
    }
    await run("document.querySelector('#files').open = false")
    return said.join(', ')
  })

  await step(`${edits} random edits`, async () => {
    await show((await surface('barth-6')).replace('400 300', '24 18'))
    await run(`
      const pieces = ['{', '}', '"', ' 1e300 ', '-', ' sphere ', 'let k 0\\n', '😀', 'formula', '^', '(', '\\n', '#', 'repeat i 3 {', '0', ' 7 ', 'x', '*y']
      let seed = 7
      const below = (most) => { seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0; return Math.floor(seed / 4294967296 * most) }
      const original = editor.value
      const edit = (text) => {
        for (let times = 1 + below(3); times > 0; times--) {
          const at = below(text.length + 1), end = at + below(6)
          text = below(2) ? text.slice(0, at) + pieces[below(pieces.length)] + text.slice(at) : text.slice(0, at) + text.slice(end)
        }
        return text
      }
      const together = (text, at) => Promise.all([read(text), helper('diagnose', text), helper('complete/' + at, text), helper('hover/' + at, text), helper('format', text)])
      let longest = 0
      window.goOnEditing = async (count) => {
        for (let done = 0; done < count; done++) {
          const text = edit(original), begun = performance.now()
          let timer = 0
          const hangs = new Promise((done) => { timer = setTimeout(done, 60000, text) })
          if (await Promise.race([together(text, below(text.length + 1)), hangs]) === text) return { hangs: text }
          clearTimeout(timer)
          longest = Math.max(longest, performance.now() - begun)
        }
        const memory = await Promise.all([painter, helper].map(async (ask) => +await (await ask('memory')).text()))
        return { memory, scripts: (await performance.measureUserAgentSpecificMemory()).bytes, longest: Math.round(longest) }
      }`)
    // Some at a time: no answer of the driver may take minutes.
    let before, after
    const late = +(await data('late') ?? 0)
    for (let done = 0; done < edits; done += 300) {
      after = await until('goOnEditing(arguments[0]).then(done)', Math.min(300, edits - done))
      assert(!after.hangs, `no answer for a minute: ${after.hangs}`)
      before ??= after
    }
    assert.equal(+(await data('restarts') ?? 0), 0, 'the program ended')
    const most = (bytes) => bytes + (32 << 20)
    after.memory.forEach((bytes, index) => assert(bytes <= most(before.memory[index]), `${before.memory} bytes became ${after.memory}`))
    assert(after.scripts <= most(before.scripts), `${before.scripts} bytes became ${after.scripts}`)
    const told = ({ memory, scripts }) => `${[...memory, scripts].map((bytes) => (bytes / (1 << 20)).toFixed(1)).join(' + ')} MiB`
    return `the longest took ${after.longest} ms, ${+(await data('late') ?? 0) - late} workers were given up; memory of the painter, of the helper, and of all scripts: ${told(before)} after 300, ${told(after)} at the end`
  })

  await step('the page is there without a network', async () => {
    await go(served)
    await until("navigator.serviceWorker.ready.then(() => done(true))")
    await pause(500)
    await new Promise((done) => { server.close(done); server.closeAllConnections() })
    await send('/refresh', {})
    await wait(`document.documentElement.dataset.ready && ${isShown}`)
  })

  await step('one file works without a server', async () => {
    await go(`${pathToFileURL(join(web, 'tabray.html'))}#surface=heart`)
    await wait(`document.documentElement.dataset.ready && ${isShown}`)
    const text = await run('return editor.value')
    assert((await canvas()).equals(native(text)))
  })

  await step('within an editor, the page shows its text, and tells it what changes', async () => {
    const { identifier } = await command('Page.addScriptToEvaluateOnNewDocument', { source: 'window.sent = []; window.acquireVsCodeApi = () => ({ postMessage: (message) => sent.push(message) })' })
    await go('about:blank')
    await go(pathToFileURL(join(web, 'tabray.html')).href)
    await wait('sent[0]?.ready')
    const type = (text) => run("postMessage({ text: arguments[0] }, '*')", text)
    const torus = readFileSync(join(sources, 'scenes/entities/texplane.ray'), 'utf8').replace('../', '').replace(/samples +\d+/, 'samples 1')
    await type(torus)
    await wait("sent.at(-1).lacks?.join() === 'textures/bricks.png'")
    await run("postMessage({ files: [{ name: 'textures/bricks.png', bytes: Uint8Array.from(arguments[0]) }] }, '*')", [...readFileSync(join(sources, 'scenes/textures/bricks.png'))])
    await wait(isShown)
    assert((await canvas()).equals(native(torus.replace('textures/', `${join(sources, 'scenes/textures')}/`))))
    const heart = `let k 1\n${torus}`
    await type(heart)
    await wait(`editor.value.startsWith('let k 1') && ${isShown}`)
    await run('refresh()')
    await wait("document.querySelector('#field-k-0')")
    await run("const box = document.querySelector('#field-k-0'); box.value = 2; box.dispatchEvent(new Event('input'))")
    await wait("sent.at(-1).text?.startsWith('let k 2')")
    assert.equal((await run('return sent.at(-1)')).before, heart)
    await shot('hosted')
    await command('Page.removeScriptToEvaluateOnNewDocument', { identifier })
  })

  writeFileSync(file, await surface('barth-6'))
  const watching = spawn(program, ['watch', file, '--port', '0'], { stdio: ['ignore', 'ignore', 'pipe'] })
  try {
    const said = await new Promise((done) => watching.stderr.once('data', (bytes) => done(`${bytes}`)))
    await go(said.match(/http:\S+/)[0])
    await wait(`version && ${watched.isShown}`)
    await both(watched)
  } finally {
    watching.kill()
  }
} finally {
  await send('', null, 'DELETE').catch(() => {})
  driver.kill()
  server.close()
  rmSync(work, { recursive: true })
}
