(function () {
  'use strict';
  var svg = document.getElementById('map');
  if (!svg) return;
  var home = svg.getAttribute('viewBox').split(' ').map(Number), view = home.slice();
  function show(box) { view = box; svg.setAttribute('viewBox', box.join(' ')); }
  function here(event) {
    var p = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    return [p.x, p.y];
  }
  function all() {
    var box = [home[0], home[1], home[0] + home[2], home[1] + home[3]];
    document.querySelectorAll('.map > input[data-view]:checked').forEach(function (input) {
      var v = input.dataset.view.split(' ').map(Number);
      box = [Math.min(box[0], v[0]), Math.min(box[1], v[1]), Math.max(box[2], v[0] + v[2]), Math.max(box[3], v[1] + v[3])];
    });
    return [box[0], box[1], box[2] - box[0], box[3] - box[1]];
  }
  document.querySelectorAll('.map > input[data-view]').forEach(function (input) {
    input.addEventListener('change', function () { show(all()); });
  });
  svg.addEventListener('wheel', function (event) {
    event.preventDefault();
    var scale = Math.pow(1.0015, event.deltaY), at = here(event), width = view[2] * scale;
    if (width > 8 * home[2] || width < home[2] / 80) return;
    show([at[0] + (view[0] - at[0]) * scale, at[1] + (view[1] - at[1]) * scale, width, view[3] * scale]);
  }, { passive: false });
  var grip = null;
  svg.addEventListener('pointerdown', function (event) { grip = here(event); svg.setPointerCapture(event.pointerId); svg.classList.add('moving'); });
  svg.addEventListener('pointermove', function (event) {
    if (!grip) return;
    var at = here(event);
    show([view[0] + grip[0] - at[0], view[1] + grip[1] - at[1], view[2], view[3]]);
  });
  ['pointerup', 'pointercancel'].forEach(function (name) {
    svg.addEventListener(name, function () { grip = null; svg.classList.remove('moving'); });
  });
  svg.addEventListener('dblclick', function () { show(all()); });
})();
