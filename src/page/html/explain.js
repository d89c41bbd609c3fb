// The explanation of a pixel.

const explain = async ([x, fromTop]) => {
  mark = [x, fromTop]
  $('#mark').hidden = false
  place()
  const of = version
  const answer = await ask(`probe/${of}/${x}/${height - 1 - fromTop}`, 'json')
  if (!answer || of !== version || mark?.[0] !== x || mark[1] !== fromTop) return
  const { text, lines } = answer
  $('#told pre').textContent = text
  $('#told pre').scrollTop = 0
  $('#told').hidden = false
  $('aside').classList.add('explains')
  markLines(textIsThePicture ? lines : null)
}

/// Explains a pixel, shows the values of its object, and makes the camera orbit its point.
const look = (at) => { explain(at); fetchFields(at); turnAround(at) }
