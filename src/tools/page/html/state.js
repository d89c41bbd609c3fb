'use strict'
const $ = (selector) => document.querySelector(selector)
// Characters that are not seen, as the program shows them in its messages.
const visible = (text) => text.replace(/(?!\t)[\p{Cc}\p{Default_Ignorable_Code_Point}\p{Zl}\p{Zp}\p{Bidi_Control}]/gu,
  (letter) => `\\u{${letter.codePointAt(0).toString(16)}}`)
const root = document.documentElement, stage = $('#stage'), sheet = $('#sheet'), canvas = $('canvas')
const paper = canvas.getContext('2d')

// The picture: its colours, as they are traced, and how many of its pixels are final.
let version = 0, width = 0, height = 0, colours = new Float32Array(0), ready = 0
// When the first pixels became final.
let began = 0
// Whether the text is the one that the picture was made from.
let textIsThePicture = false
let layer = 'picture', stops = 0

let words = ''
// Whether another picture than the one chosen is on the canvas.
let waits = false

const tell = () => { $('#state').textContent = waits ? `loading ${layer}` : words }
const state = (name, said) => {
  root.dataset.state = name
  words = said
  tell()
  // Progress is not read out; errors have a place of their own.
  if (['done', 'lost'].includes(name)) announce(said)
}

/// Tells readers of the screen.
const announce = (said) => { $('#said').textContent = said }

// What else is done when a scene comes, when its picture is complete, and when the picture is drawn anew.
const on = { scene: [], done: [], drawn: [] }
const happens = (what) => { for (const act of on[what]) act() }

// What keys do.
const bindings = {}
