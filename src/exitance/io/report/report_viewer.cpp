#include <fmt/format.h>

#include <cstring>

#include "exitance/base/triangulation.hpp"
#include "exitance/io/export/light_map_files.hpp"
#include "exitance/io/files/base64.hpp"
#include "exitance/io/pictures/display.hpp"
#include "exitance/io/pictures/tone_map.hpp"
#include "exitance/io/report/report_figures.hpp"

namespace exitance {
namespace {

/// Corners (x, y, z, u, v) and triangles of all faces that are in one map.
struct Triangles {
    std::vector<float> corners;
    std::vector<std::uint32_t> index;
};

Triangles triangles_of(const Scene& scene, const LightMaps& light, std::size_t m) {
    Triangles out;
    for (SurfaceId s : scene.surfaces().ids()) {
        const Chart& chart = light.charts[scene.surfaces()[s].region.value];
        if (chart.map != m) continue;
        const auto first = static_cast<std::uint32_t>(out.corners.size() / 5);
        for (const auto& triangle : triangulate(scene.outline(s), scene.surfaces()[s].normal))
            for (const std::uint32_t corner : triangle) out.index.push_back(first + corner);
        for (const Point& p : scene.outline(s)) {
            const Vec2 place = chart.place(p);
            for (const double value : {p.x, p.y, p.z, (chart.x + place.x) / light.maps[m].size.width,
                                       (chart.y + place.y) / light.maps[m].size.height})
                out.corners.push_back(static_cast<float>(value));
        }
    }
    return out;
}

constexpr const char* script = R"js(
(() => {
  const canvas = document.getElementById('viewer'), gl = canvas.getContext('webgl2', {antialias: true});
  if (!gl) { canvas.replaceWith('This browser has no WebGL: the viewer is left out.'); return; }
  const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer;
  const shader = (kind, text) => { const s = gl.createShader(kind); gl.shaderSource(s, text); gl.compileShader(s); return s; };
  const program = gl.createProgram();
  gl.attachShader(program, shader(gl.VERTEX_SHADER, `#version 300 es
    in vec3 p; in vec2 t; out vec2 at; uniform mat4 m; void main() { at = t; gl_Position = m * vec4(p, 1.0); }`));
  gl.attachShader(program, shader(gl.FRAGMENT_SHADER, `#version 300 es
    precision highp float; in vec2 at; out vec4 colour; uniform sampler2D map;
    void main() { colour = gl_FrontFacing ? texture(map, at) : vec4(0.13, 0.13, 0.14, 1.0); }`));
  gl.linkProgram(program); gl.useProgram(program);
  gl.enable(gl.DEPTH_TEST);
  const parts = VIEWER.parts.map(part => {
    const array = gl.createVertexArray(); gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, bytes(part.corners), gl.STATIC_DRAW);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    const index = bytes(part.index); gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, index, gl.STATIC_DRAW);
    [['p', 3, 0], ['t', 2, 12]].forEach(([name, count, offset]) => {
      const place = gl.getAttribLocation(program, name);
      gl.enableVertexAttribArray(place); gl.vertexAttribPointer(place, count, gl.FLOAT, false, 20, offset);
    });
    const texture = gl.createTexture(), image = new Image();
    image.onload = () => {
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, image);
      gl.generateMipmap(gl.TEXTURE_2D);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAX_LEVEL, 2);
      draw();
    };
    image.src = part.picture;
    return {array, texture, count: index.byteLength / 4};
  });
  const sub = (a, b) => a.map((x, i) => x - b[i]), dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = a => { const l = Math.hypot(...a) || 1; return a.map(x => x / l); };
  let eye = VIEWER.eye.slice(), ahead = unit(sub(VIEWER.target, VIEWER.eye));
  const basis = () => { const right = unit(cross(ahead, [0, 0, 1])); return [right, cross(right, ahead)]; };
  function draw() {
    const [right, up] = basis(), w = canvas.width, h = canvas.height, near = VIEWER.size / 2000, far = VIEWER.size * 4;
    const x = 1 / Math.tan(VIEWER.fov * Math.PI / 360), y = x * w / h, a = (far + near) / (far - near), b = -2 * far * near / (far - near);
    const rows = [[...right.map(v => v * x), -dot(right, eye) * x], [...up.map(v => v * y), -dot(up, eye) * y],
      [...ahead.map(v => v * a), -dot(ahead, eye) * a + b], [...ahead, -dot(ahead, eye)]];
    const matrix = new Float32Array(16);
    rows.forEach((row, i) => row.forEach((v, j) => matrix[4 * j + i] = v));
    gl.viewport(0, 0, w, h); gl.clearColor(0.08, 0.08, 0.09, 1); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix4fv(gl.getUniformLocation(program, 'm'), false, matrix);
    for (const part of parts) {
      gl.bindVertexArray(part.array); gl.bindTexture(gl.TEXTURE_2D, part.texture);
      gl.drawElements(gl.TRIANGLES, part.count, gl.UNSIGNED_INT, 0);
    }
  }
  const turn = (dx, dy) => {
    const [right, up] = basis(), k = VIEWER.fov * Math.PI / 180 / canvas.clientWidth;
    const next = unit(ahead.map((v, i) => v - dx * k * right[i] + dy * k * up[i]));
    if (Math.abs(next[2]) < 0.98) ahead = next;
    draw();
  };
  const go = (along, across, rise) => {
    const [right] = basis(), step = VIEWER.size / 60;
    eye = eye.map((v, i) => v + step * (along * ahead[i] + across * right[i] + (i === 2 ? rise : 0)));
    draw();
  };
  canvas.addEventListener('pointerdown', e => canvas.setPointerCapture(e.pointerId));
  canvas.addEventListener('pointermove', e => { if (e.buttons) turn(e.movementX, e.movementY); });
  canvas.addEventListener('wheel', e => { e.preventDefault(); go(e.deltaY < 0 ? 1 : -1, 0, 0); }, {passive: false});
  const keys = {ArrowUp: [1, 0, 0], ArrowDown: [-1, 0, 0], ArrowLeft: [0, -1, 0], ArrowRight: [0, 1, 0], PageUp: [0, 0, 1], PageDown: [0, 0, -1]};
  canvas.addEventListener('keydown', e => { if (keys[e.key]) { e.preventDefault(); go(...keys[e.key]); } });
})();
)js";

std::string triple(const Vec3& v) {
    return fmt::format("[{},{},{}]", v.x, v.y, v.z);
}

}  // namespace

Result<std::string> report_viewer(const ReportContent& content) {
    if (!content.viewer) return std::string();
    const Scene& scene = content.solution->scene;
    ToneMap tone = make_tone_map(*content.solution);
    tone.curve = ToneCurve::filmic;
    std::string parts;
    for (std::size_t m = 0; m < content.viewer->maps.size(); ++m) {
        const Result<std::string> picture =
            data_address(map_picture(scene, *content.viewer, m, LightMapQuantity::radiosity, tone));
        if (!picture) return picture.error();
        const Triangles triangles = triangles_of(scene, *content.viewer, m);
        parts += fmt::format("{}{{corners:\"{}\",index:\"{}\",picture:\"{}\"}}", m > 0 ? "," : "",
                             base64(std::as_bytes(std::span(triangles.corners))),
                             base64(std::as_bytes(std::span(triangles.index))), *picture);
    }
    return fmt::format(
        "<canvas id=\"viewer\" width=\"960\" height=\"600\" tabindex=\"0\"></canvas>\n<p class=\"note\">Drag to look "
        "around, wheel or arrow keys to walk, page keys to rise and sink.</p>\n<script>\nconst VIEWER = "
        "{{eye:{},target:{},fov:{},size:{},parts:[{}]}};\n{}</script>\n",
        triple(content.view.eye), triple(content.view.target), content.view.fov, scene.size(), parts, script);
}

}  // namespace exitance
