import * as THREE from 'three';
import {load_facts, load_line, load_point, load_state, post, type Facts, type Triple} from './data';
import {order_colours} from './elements';
import {by_id, draw_outlines, point_words, profile_csv, show_plot, type Profile} from './measure';
import {Panes, type Arrangement, type Source} from './panes';
import {class_colours, css, round_steps, Shading, type Shown} from './shading';
import {Viewpoint} from './camera';
import {WhatIf} from './what_if';

performance.mark('script');
const asked_state = load_state(), asked_facts = load_facts();
asked_facts.catch(() => {});  // told below; of a running solve there are none yet
const canvas = by_id<HTMLCanvasElement>('picture'), place = by_id('view');
const renderer = new THREE.WebGLRenderer({canvas, antialias: true, preserveDrawingBuffer: true});
renderer.outputColorSpace = THREE.LinearSRGBColorSpace;  // the shader encodes by itself, as `render` does
size_picture();
performance.mark('renderer');
const chosen = new THREE.Group(), shooters = new THREE.Group(), marks = new THREE.Group();
marks.add(chosen, shooters);
const box = (id: string) => by_id<HTMLInputElement>(id), choice = (id: string) => by_id<HTMLSelectElement>(id).value;
let facts: Facts, shading: Shading, panes: Panes, view: Viewpoint;
let wanted = true, measuring: {point: THREE.Vector3; normal: THREE.Vector3}[] | null = null, csv = '', told_panes = '';

const redraw = () => { wanted = true; };
const width = () => Math.max(1, place.clientWidth), height = () => Math.max(1, place.clientHeight);

function paint(): void {
    renderer.setClearColor(getComputedStyle(document.documentElement).getPropertyValue('--sky').trim());
    panes.draw(renderer, view, width(), height(), box('mesh').checked);
    if (panes.sources().map(s => panes.words(s)).join() !== told_panes) show_panes();
}

function draw(last: number): void {
    requestAnimationFrame(now => {
        if (view.fly((now - last) / 1000)) redraw();
        view.keep();
        if (wanted) { wanted = false; paint(); }
        draw(now);
    });
}

function size_picture(): void {
    renderer.setPixelRatio(window.devicePixelRatio);
    renderer.setSize(Math.max(1, place.clientWidth), Math.max(1, place.clientHeight), false);
}

function resize(): void {
    size_picture();
    show_panes();
    redraw();
}

const unit_of = (radiosity: boolean) => radiosity ? (facts.photometric ? 'exitance, lm/m²' : 'radiosity, W/m²')
    : (facts.photometric ? 'illuminance, lx' : 'irradiance, W/m²');

function legend_row(colour: string, words: string, line = false): HTMLElement {
    const row = document.createElement('div'), mark = document.createElement('i');
    if (line) mark.className = 'line', mark.style.borderColor = colour;
    else mark.style.background = colour;
    row.append(mark, words);
    return row;
}

function show_legend(shown: Shown, isolux: boolean): void {
    const legend = by_id('legend'), rows: (HTMLElement | string)[] = [], values = shown === 'radiosity' || shown === 'irradiance';
    if (values || isolux) rows.push(Object.assign(document.createElement('strong'), {textContent: unit_of(shown === 'radiosity')}));
    for (const {colour, from, to} of values || isolux ? shading.legend() : [])
        rows.push(values ? legend_row(colour, `${from} – ${to}`) : legend_row(colour, `${from}`, true));
    if (shown === 'classes') for (const [name, colour] of class_colours) rows.push(legend_row(css(colour), name));
    if (box('mesh').checked && facts.discontinuities)
        for (const [name, colour] of Object.values(order_colours)) rows.push(legend_row(css(colour), name, true));
    legend.hidden = rows.length === 0;
    legend.replaceChildren(...rows);
}

/** Everything that the settings say. */
function apply(): void {
    const shown = choice('quantity') as Shown, stops = Number(box('exposure').value), isolux = box('isolux').checked;
    shading.show(shown, isolux);
    shading.uniforms.curve.value = Number(choice('tone'));
    shading.uniforms.scale.value = facts.exposure * 2 ** stops;
    by_id('exposure_text').textContent = `${stops >= 0 ? '+' : ''}${stops.toFixed(1)} stops`;
    if (shown !== 'picture' || isolux) shading.set_steps(round_steps(...panes.layers.delivered.range(shown === 'radiosity')));
    show_legend(shown, isolux);
    redraw();
}

/** Names of the panes, and the dividers between them. */
function show_panes(): void {
    if (!panes) return;
    const all = panes.panes(width()), split = panes.arrangement === 'split';
    const named = all.filter(p => p.right - p.left > 30 && (all.length > 1 || !/^\w+$/.test(panes.words(p.source))));
    told_panes = all.map(p => panes.words(p.source)).join();
    by_id('panes').replaceChildren(...named.map(p => {
        const name = Object.assign(document.createElement('span'), {textContent: panes.words(p.source)});
        name.style.left = `${p.left + 10}px`;
        return name;
    }));
    document.querySelectorAll<HTMLElement>('.divider').forEach((divider, i) => {
        divider.hidden = !split;
        divider.style.left = `${panes.dividers[i] * width()}px`;
        divider.setAttribute('aria-valuenow', String(Math.round(100 * panes.dividers[i])));
    });
    redraw();
}

async function arrange(): Promise<void> {
    panes.arrangement = choice('arrangement') as Arrangement;
    panes.source = choice('source') as Source;
    by_id<HTMLSelectElement>('source').disabled = panes.arrangement !== 'one';
    show_panes();
    try { await panes.load(); } catch (error) { by_id('point').textContent = String(error); }
    if (panes.sources().includes('raw')) document.body.dataset.raw = '1';
    apply();
}

function move_divider(i: number, to: number): void {
    const d = panes.dividers;
    d[i] = Math.min(Math.max(to, i === 0 ? 0 : d[0]), i === 0 ? d[1] : 1);
    show_panes();
}

async function pick(x: number, y: number): Promise<void> {
    const found = panes.hit(x, y, width(), height(), view);
    if (!found || !found.hit.face) { by_id('point').textContent = 'nothing there'; return; }
    const point = found.hit.point, normal = found.hit.face.normal;
    try {
        if (measuring) return await add_end(point, normal);
        const light = await load_point([...point.toArray(), ...normal.toArray()], panes.change);
        by_id('point').textContent = point_words(light, point, facts.photometric ? 'lx' : 'W/m²');
        chosen.clear();
        draw_outlines(chosen, [found.outline], 0xff7a1a);
        const linked = (light.links ?? []).map(l => l.outline.map(p => new THREE.Vector3(...p)));
        draw_outlines(chosen, linked, 0x2f7de1);
        draw_outlines(chosen, linked.map(corners => [point, corners.reduce((sum, p) => sum.add(p), new THREE.Vector3()).divideScalar(corners.length)]),
            0x2f7de1, false);
        redraw();
    } catch (error) { by_id('point').textContent = String(error); }
}

async function add_end(point: THREE.Vector3, normal: THREE.Vector3): Promise<void> {
    measuring!.push({point, normal: normal.clone()});
    if (measuring!.length < 2) { by_id('point').textContent = 'now the other end'; return; }
    const [a, b] = measuring!;
    measuring = null;
    chosen.clear();
    draw_outlines(chosen, [[a.point, b.point]], 0xff7a1a, false);
    redraw();
    const profile = await load_line([...a.point.toArray(), ...b.point.toArray(), ...b.normal.toArray()], panes.change) as Profile;
    const unit = facts.photometric ? 'lx' : 'W/m²';
    by_id('point').textContent = `light along ${profile.length.toPrecision(4)} m: ${Math.min(...profile.values).toPrecision(4)} to ` +
        `${Math.max(...profile.values).toPrecision(4)} ${unit}, ${facts.photometric ? 'bands weighted as the eye does' : 'mean of the bands'}`;
    csv = profile_csv(profile, a.point, b.point, unit);
    show_plot(profile, unit);
}

function measure(): void {
    measuring = [];
    by_id('point').textContent = 'click on one end, or Enter for the cross in the middle';
}

function show_facts(): void {
    by_id('name').textContent = facts.file.split('/').pop() ?? 'exitance';
    by_id('facts').textContent = `${facts.method}, ${facts.basis} basis, ${facts.surfaces} faces, ${facts.elements} elements` +
        (facts.error === null ? '' : `, error ${(100 * facts.error).toPrecision(2)}%`);
    const classes = by_id<HTMLSelectElement>('quantity').querySelector<HTMLOptionElement>('[value=classes]')!;
    classes.hidden = classes.disabled = !facts.shadow_classes;
}

async function load(first: boolean, known: Facts | null = null): Promise<void> {
    facts = known ?? await load_facts();
    performance.mark('facts');
    const old = panes;
    shading = new Shading(facts);
    const fresh: Panes = new Panes(facts, shading, marks, redraw);
    if (old) [fresh.arrangement, fresh.source, fresh.dividers] = [old.arrangement, old.source, old.dividers];
    // What was there stays in sight until there is something new.
    await fresh.layers.delivered.load(fresh.change, () => {
        performance.mark('buffers');
        if (panes !== fresh) {
            panes = fresh;
            old?.dispose();
            if (first) {
                view = new Viewpoint(facts, canvas, redraw);
                view.controls.addEventListener('end', () => view.to_address());
                performance.mark('viewpoint');
                show_panes();
                draw(performance.now());
            }
            show_facts();
        }
        apply();
        if (!document.body.dataset.first) {
            performance.mark('elements');
            paint();
            performance.mark('first');
            document.body.dataset.first = performance.now().toFixed(0);
        }
    });
    await panes.load();
    apply();
    document.body.dataset.ready = '1';
    await new WhatIf(facts, panes, shading, apply).show();
    document.body.dataset.whatif = '1';
}

/** A running solve tells what it does, and when there is better light. */
function follow(): void {
    const events = new EventSource('/data/events');
    by_id('running').hidden = false;
    events.addEventListener('progress', event => {
        const {phase, fraction, shooter} = JSON.parse((event as MessageEvent).data) as {phase: string; fraction: number; shooter: Triple[]};
        shooters.clear();
        if (shooter.length > 2) {
            draw_outlines(shooters, [shooter.map(p => new THREE.Vector3(...p))], 0xffd21a);
            document.body.dataset.shooters = String(Number(document.body.dataset.shooters ?? 0) + 1);
        }
        redraw();
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
        shooters.clear();
        redraw();
        document.body.dataset.ended = '1';
        events.close();
    });
}

function save_file(name: string, type: string, text: string): void {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([text], {type}));
    link.download = name;
    link.click();
}

for (const id of ['quantity', 'tone', 'exposure', 'mesh', 'isolux']) by_id(id).addEventListener('input', () => panes && apply());
for (const id of ['source', 'arrangement']) by_id(id).addEventListener('input', () => panes && void arrange());
by_id('fit').addEventListener('click', () => { view.fit(); view.to_address(); });
by_id('line').addEventListener('click', measure);
by_id('record').addEventListener('click', () => {
    view.record();
    by_id('record').textContent = view.recording ? 'Stop recording' : 'Record path';
    for (const id of ['replay', 'save_path']) by_id(id).hidden = view.recording || view.path.length === 0;
});
by_id('replay').addEventListener('click', () => view.replay());
by_id('save_path').addEventListener('click', () => save_file('path.csv', 'text/csv', view.path_text()));
by_id('copy').addEventListener('click', () => navigator.clipboard.writeText(csv).then(() => { by_id('point').textContent = 'copied'; },
    () => save_file('line.csv', 'text/csv', csv)));
by_id('stop').addEventListener('click', () => post('/data/stop').catch(error => { by_id('phase').textContent = String(error); }));
by_id('save').addEventListener('click', () => post('/data/save').then(text => { by_id('phase').textContent = text; },
    error => { by_id('phase').textContent = String(error); }));
document.querySelectorAll<HTMLElement>('.divider').forEach((divider, i) => {
    divider.addEventListener('pointerdown', event => divider.setPointerCapture(event.pointerId));
    divider.addEventListener('pointermove', event => {
        if (divider.hasPointerCapture(event.pointerId)) move_divider(i, (event.clientX - place.getBoundingClientRect().left) / width());
    });
    divider.addEventListener('keydown', event => {
        const step = (event.shiftKey ? 0.05 : 0.01) * (event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0);
        if (step !== 0) { event.preventDefault(); move_divider(i, panes.dividers[i] + step); }
    });
});
let pressed: [number, number] = [0, 0];
canvas.addEventListener('pointerdown', event => { pressed = [event.clientX, event.clientY]; canvas.focus(); });
canvas.addEventListener('pointerup', event => {
    if (panes && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 4) void pick(event.offsetX, event.offsetY);
});
canvas.addEventListener('keyup', event => {
    if (!panes || event.ctrlKey || event.metaKey) return;
    const toggle = (id: string) => { box(id).checked = !box(id).checked; apply(); };
    const key = event.key.toLowerCase();
    if (key === 'f') view.fit();
    if (key === 'm') toggle('mesh');
    if (key === 'i') toggle('isolux');
    if (key === 'l') measure();
    if (key === 'c') {
        const select = by_id<HTMLSelectElement>('arrangement');
        select.selectedIndex = (select.selectedIndex + 1) % select.options.length;
        void arrange();
    }
    if (key === 'enter') {
        const middle = panes.panes(width())[panes.arrangement === 'panes' ? 1 : 0];
        void pick(middle.view_left + middle.view_width / 2, height() / 2);
    }
    view.to_address();
});
window.addEventListener('keyup', event => {
    const typing = event.target instanceof HTMLInputElement && event.target.type !== 'checkbox' && event.target.type !== 'range';
    if (event.key.toLowerCase() === 'h' && !event.ctrlKey && !typing) { document.body.classList.toggle('alone'); if (view) resize(); }
});
window.addEventListener('resize', () => view && resize());
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
const debug = renderer.getContext().getExtension('WEBGL_debug_renderer_info');
const processor = debug ? String(renderer.getContext().getParameter(debug.UNMASKED_RENDERER_WEBGL)) : '';
by_id('software').hidden = !/swiftshader|llvmpipe|software|basic render/i.test(processor);

asked_state.then(async state => state.solving ? follow() : load(true, await asked_facts))
    .catch(error => { by_id('facts').textContent = String(error); });
Object.assign(window, {exitance: {words: () => view.words(), exposure: () => shading.uniforms.scale.value as number,
    size: () => [width(), height()], canvas: () => { paint(); return canvas.toDataURL(); },
    whole: () => panes.words('exact') === 'exact' && [shading.uniforms.light.value, shading.uniforms.rest.value].every(t => t && (t as THREE.DataTexture).image.width === Math.round(
        panes.panes(width()).at(-1)!.view_width * renderer.getPixelRatio()))}});
