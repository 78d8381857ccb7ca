import * as THREE from 'three';
import {load_facts, load_line, load_point, post, type Facts, type Light, type Triple} from './data';
import {Elements} from './elements';
import {round_steps, Shading} from './shading';
import {Viewpoint} from './camera';

const by_id = <T extends Element = HTMLElement>(id: string) => document.getElementById(id) as unknown as T;
const canvas = by_id<HTMLCanvasElement>('picture');
const renderer = new THREE.WebGLRenderer({canvas, antialias: true, preserveDrawingBuffer: true});
renderer.outputColorSpace = THREE.LinearSRGBColorSpace;  // the shader encodes by itself, as `render` does
const stage = new THREE.Scene();
const chosen = new THREE.Group();
let facts: Facts, shading: Shading, elements: Elements, view: Viewpoint;
let wanted = true, measuring: THREE.Vector3[] | null = null;

const redraw = () => { wanted = true; };

function draw(last: number): void {
    requestAnimationFrame(now => {
        if (view.fly((now - last) / 1000)) redraw();
        view.keep();
        if (wanted) {
            wanted = false;
            renderer.setClearColor(getComputedStyle(document.documentElement).getPropertyValue('--sky').trim());
            renderer.render(stage, view.camera);
        }
        draw(now);
    });
}

function resize(): void {
    renderer.setPixelRatio(window.devicePixelRatio);
    renderer.setSize(window.innerWidth, window.innerHeight, false);
    view.resize(window.innerWidth / window.innerHeight);
    redraw();
}

const unit_of = (radiosity: boolean) => radiosity ? (facts.photometric ? 'exitance, lm/m²' : 'radiosity, W/m²')
    : (facts.photometric ? 'illuminance, lx' : 'irradiance, W/m²');

/** Everything that the settings say. */
function apply(): void {
    const quantity = by_id<HTMLSelectElement>('quantity').value, u = shading.material.uniforms;
    const stops = Number(by_id<HTMLInputElement>('exposure').value), isolux = by_id<HTMLInputElement>('isolux').checked;
    u.shown.value = quantity === 'shaded' ? 0 : quantity === 'radiosity' ? 1 : 2;
    u.curve.value = Number(by_id<HTMLSelectElement>('tone').value);
    u.scale.value = facts.exposure * 2 ** stops;
    u.isolux.value = isolux;
    by_id('exposure_text').textContent = `${stops >= 0 ? '+' : ''}${stops.toFixed(1)} stops`;
    elements.lines.visible = by_id<HTMLInputElement>('mesh').checked;
    shading.set_steps(round_steps(...elements.range(quantity === 'radiosity')));
    const legend = by_id('legend');
    legend.hidden = quantity === 'shaded' && !isolux;
    legend.replaceChildren(Object.assign(document.createElement('strong'), {textContent: unit_of(quantity === 'radiosity')}));
    for (const {colour, from, to} of shading.legend()) {
        const row = document.createElement('div'), box = document.createElement('i');
        box.style.background = quantity === 'shaded' ? 'transparent' : colour;
        row.append(box, `${from} – ${to}`);
        legend.append(row);
    }
    redraw();
}

const three_digits = (v: Triple) => v.map(x => Number(x.toPrecision(4))).join('  ');

function show_point(light: Light, at: THREE.Vector3): void {
    const lines = [`at ${at.toArray().map(x => x.toFixed(3)).join(', ')} m`, `E ${three_digits(light.irradiance)}`,
        `direct ${three_digits(light.direct)}`, `reflected ${three_digits(light.indirect)}`];
    if (light.radiosity) lines.push(`B ${three_digits(light.radiosity)}`);
    if (light.surface !== undefined)
        lines.push(`face ${light.surface}${light.line ? ` (line ${light.line})` : ''}, ${light.group || 'no group'}, ` +
            `${light.material}`, `element ${light.element ?? 'none'}, ${light.links?.length ?? 0} links`);
    by_id('point').textContent = lines.join('\n');
    chosen.clear();
    const add_line = (points: THREE.Vector3[], colour: number) => chosen.add(new THREE.Line(
        new THREE.BufferGeometry().setFromPoints(points), new THREE.LineBasicMaterial({color: colour, toneMapped: false})));
    for (const {outline} of light.links ?? []) {
        const corners = outline.map(p => new THREE.Vector3(...p));
        add_line([...corners, corners[0]], 0x2f7de1);
        const middle = corners.reduce((sum, p) => sum.add(p), new THREE.Vector3()).divideScalar(corners.length);
        add_line([at, middle], 0x2f7de1);
    }
    redraw();
}

function show_plot(length: number, values: number[]): void {
    const most = Math.max(...values, 1e-12), plot = by_id<SVGSVGElement>('plot');
    const path = values.map((v, i) => `${i ? 'L' : 'M'}${30 + 220 * i / (values.length - 1)} ${105 - 90 * v / most}`).join('');
    plot.innerHTML = `<text x="2" y="18">${most.toPrecision(3)}</text><text x="2" y="105">0</text>` +
        `<text x="30" y="118">0</text><text x="215" y="118">${length.toPrecision(3)} m</text><path d="${path}"/>`;
    plot.removeAttribute('hidden');
}

async function pick(x: number, y: number): Promise<void> {
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2(2 * x / window.innerWidth - 1, 1 - 2 * y / window.innerHeight), view.camera);
    const hit = ray.intersectObjects(elements.whole.children)[0];
    if (!hit || !hit.face) { by_id('point').textContent = 'nothing there'; return; }
    const n = hit.face.normal;
    try {
        if (measuring) {
            measuring.push(hit.point);
            if (measuring.length === 2) {
                const [a, b] = measuring;
                measuring = null;
                const {length, values} = await load_line([...a.toArray(), ...b.toArray(), ...n.toArray()]);
                by_id('point').textContent = `irradiance along ${length.toPrecision(4)} m`;
                show_plot(length, values);
            } else by_id('point').textContent = 'now the other end';
            return;
        }
        show_point(await load_point([...hit.point.toArray(), ...n.toArray()]), hit.point);
    } catch (error) { by_id('point').textContent = String(error); }
}

async function load(first: boolean): Promise<void> {
    facts = await load_facts();
    if (!first) { stage.clear(); }
    shading = new Shading(facts);
    elements = new Elements(facts, shading);
    stage.add(elements.whole, elements.lines, chosen);
    by_id('name').textContent = facts.file.split('/').pop() ?? 'exitance';
    by_id('facts').textContent = `${facts.method}, ${facts.surfaces} faces, ${facts.elements} elements` +
        (facts.error === null ? '' : `, error ${(100 * facts.error).toPrecision(2)}%`);
    if (first) {
        view = new Viewpoint(facts, canvas, redraw);
        view.controls.addEventListener('end', () => view.to_address());
        resize();
        draw(performance.now());
    }
    elements.lines.visible = false;
    await elements.load(by_id<HTMLSelectElement>('layer').value as 'exported' | 'method', () => {
        if (!document.body.dataset.first) document.body.dataset.first = performance.now().toFixed(0);
        apply();
    });
    document.body.dataset.ready = '1';
}

/** A running solve tells what it does, and when there is better light. */
function follow(): void {
    const events = new EventSource('/data/events');
    by_id('running').hidden = false;
    events.addEventListener('progress', event => {
        const {phase, fraction} = JSON.parse((event as MessageEvent).data);
        by_id<HTMLProgressElement>('progress').value = fraction;
        by_id('phase').textContent = phase;
    });
    let loading: Promise<void> = Promise.resolve(), shown = false;
    events.addEventListener('light', event => {
        const {count} = JSON.parse((event as MessageEvent).data);
        document.body.dataset.snapshots = String(count);
        loading = loading.then(() => load(!shown)).then(() => { shown = true; });
    });
    events.addEventListener('end', event => {
        by_id('phase').textContent = JSON.parse((event as MessageEvent).data).message;
        by_id<HTMLProgressElement>('progress').value = 1;
        by_id('stop').setAttribute('disabled', '');
        document.body.dataset.ended = '1';
        events.close();
    });
}

for (const id of ['quantity', 'tone', 'exposure', 'mesh', 'isolux']) by_id(id).addEventListener('input', () => elements && apply());
by_id('layer').addEventListener('input', () => elements.load(by_id<HTMLSelectElement>('layer').value as 'exported' | 'method', apply));
by_id('fit').addEventListener('click', () => { view.fit(); view.to_address(); });
by_id('line').addEventListener('click', () => { measuring = []; by_id('point').textContent = 'click on one end'; });
by_id('record').addEventListener('click', () => {
    view.record();
    by_id('record').textContent = view.recording ? 'Stop recording' : 'Record path';
    for (const id of ['replay', 'save_path']) by_id(id).hidden = view.recording || view.path.length === 0;
});
by_id('replay').addEventListener('click', () => view.replay());
by_id('save_path').addEventListener('click', () => {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([view.path_text()], {type: 'text/csv'}));
    link.download = 'path.csv';
    link.click();
});
by_id('stop').addEventListener('click', () => post('/data/stop').catch(error => { by_id('phase').textContent = String(error); }));
by_id('save').addEventListener('click', () => post('/data/save').then(text => { by_id('phase').textContent = text; },
    error => { by_id('phase').textContent = String(error); }));
let pressed: [number, number] = [0, 0];
canvas.addEventListener('pointerdown', event => { pressed = [event.clientX, event.clientY]; canvas.focus(); });
canvas.addEventListener('pointerup', event => {
    if (elements && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 4) void pick(event.clientX, event.clientY);
});
canvas.addEventListener('keyup', event => {
    const toggle = (id: string) => { const box = by_id<HTMLInputElement>(id); box.checked = !box.checked; apply(); };
    if (event.key === 'f') view.fit();
    if (event.key === 'm') toggle('mesh');
    if (event.key === 'i') toggle('isolux');
    if (event.key === 'Enter') void pick(window.innerWidth / 2, window.innerHeight / 2);
    view.to_address();
});
window.addEventListener('resize', () => view && resize());
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);

fetch('/data/state').then(r => r.json()).then(state => state.solving ? follow() : load(true))
    .catch(error => { by_id('facts').textContent = String(error); });
Object.assign(window, {exitance: {words: () => view.words(), exposure: () => shading.material.uniforms.scale.value,
    canvas: () => { renderer.render(stage, view.camera); return canvas.toDataURL(); }}});
