// What the program tells.

// What lets this page ask anything: the query of its address.
const token = location.search

/// Asks the program for something.
const request = (path, how) => fetch(path + token, how)
const post = (path, body) => request(path, { method: 'POST', body }).catch(() => null)

/// What the program answers, in one form or another, or nothing. Of each form the last answer alone is of interest: the
/// program need not work at the one before.
const asked = {}
const ask = (path, form) => {
  asked[form]?.abort()
  asked[form] = new AbortController()
  const answer = request(path, { signal: asked[form].signal })
  return answer.then((answer) => answer.ok ? answer[form]() : null).catch(() => null)
}

const follow = () => {
  const events = new EventSource(`events${token}`)
  const tells = (name, act) => events.addEventListener(name, (event) => act(event.data))
  tells('scenes', (data) => listScenes(JSON.parse(data)))
  tells('watching', (data) => {
    const refused = JSON.parse(data)
    $('#deaf').textContent = refused
    $('#deaf').hidden = !refused
  })
  tells('tried', (data) => differ(JSON.parse(data)))
  tells('scene', (data) => begin(JSON.parse(data)))
  tells('part', (data) => {
    const [of, left, top, wide, high, block, isFinal, base64] = data.split(' ')
    if (+of === version) part(+left, +top, +wide, +high, +block, +isFinal, numbers(base64))
  })
  tells('done', (data) => finish(JSON.parse(data)))
  tells('remark', (data) => remark(JSON.parse(data)))
  tells('fault', (data) => refuse(JSON.parse(data)))
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
