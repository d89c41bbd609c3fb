'use strict'
const $ = (selector) => document.querySelector(selector)
// Shows invisible characters as the program's messages do.
const visible = (text) => text.replace(/(?!\t)[\p{Cc}\p{Default_Ignorable_Code_Point}\p{Zl}\p{Zp}\p{Bidi_Control}]/gu,
  (letter) => `\\u{${letter.codePointAt(0).toString(16)}}`)
const root = document.documentElement, stage = $('#stage'), sheet = $('#sheet'), canvas = $('canvas')
const paper = canvas.getContext('2d')

// The picture: its traced colours, and the number of its final pixels.
let version = 0, width = 0, height = 0, colours = new Float32Array(0), ready = 0
// The time when the first pixels became final.
let began = 0
// Whether the picture was made from the text.
let textIsThePicture = false
let layer = 'picture', stops = 0

let words = ''
// Whether the canvas shows another layer than the chosen one.
let waits = false

const tell = () => { $('#state').textContent = waits ? `loading ${layer}` : words }
const state = (name, said) => {
  root.dataset.state = name
  words = said
  tell()
  // Screen readers do not announce progress; errors have their own element.
  if (['done', 'lost'].includes(name)) announce(said)
}

/// Announces text to screen readers.
const announce = (said) => { $('#said').textContent = said }

// Further actions when a scene arrives, when its picture is complete, when the picture is drawn again, and when it has
// another place or size on the screen.
const on = { scene: [], done: [], drawn: [], placed: [] }
const happens = (what) => { for (const act of on[what]) act() }

// The actions of keys.
const bindings = {}
