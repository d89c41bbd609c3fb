// Conversion of light to the image's bytes: like the program's, up to rounding.

// The rules of the scene; the notes' until one arrives.
let display = { rules: 'notes', exposure: 0, tone: 'clip', transfer: 'linear' }

/// Returns a colour after the Khronos PBR neutral tone mapper.
const neutral = (colour) => {
  const shoulder = 0.76, room = 1 - shoulder
  const least = Math.min(...colour), offset = least < 0.08 ? least - 6.25 * least * least : 0.04
  const rest = colour.map((channel) => channel - offset), peak = Math.max(...rest)
  if (peak < shoulder) return rest
  const top = 1 - room * room / (peak + room - shoulder), white = 1 - 1 / (0.15 * (peak - top) + 1)
  return rest.map((channel) => channel * top / peak * (1 - white) + top * white)
}

const encode = (light) => {
  if (display.transfer === 'linear') return light
  return light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055
}

/// The screen's brightness for light up to white, and the inverse.
const toScreen = (light) => display.rules === 'notes' ? light : encode(light)
const toLight = (shown) => {
  if (display.rules === 'notes' || display.transfer === 'linear') return shown
  return shown <= 0.04045 ? shown / 12.92 : ((shown + 0.055) / 1.055) ** 2.4
}

/// Returns the three bytes of a pixel, with extra stops of exposure.
const bytesOf = (colours, at, more = 0) => {
  const gain = 2 ** (display.exposure + more)
  const light = [0, 1, 2].map((channel) => Math.min(Math.max(gain * colours[at + channel] || 0, 0), Number.MAX_VALUE))
  if (display.rules === 'notes') return light.map((channel) => Math.min(Math.trunc(255 * channel), 255))
  const toned = display.tone === 'clip' ? light : neutral(light)
  return toned.map((channel) => Math.round(255 * encode(Math.min(channel, 1))))
}
