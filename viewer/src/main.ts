import * as THREE from 'three';
import {Card} from './card';
import {round_steps, short} from './colours';
import {Compare} from './compare';
import {load_facts, load_point, load_share, load_state, type Facts, type Light, type State, type Triple} from './data';
import {clear_labels, show_labels} from './labels';
import {show_legend, title_of} from './legend';
import {LineTool} from './line_tool';
import {draw_outlines} from './measure';
import {Objects} from './objects';
import {overview} from './overview';
import {box, by_id, choice, make} from './page';
import {Panes, type Arrangement, type Found, type Source} from './panes';
import {follow_solve} from './running_solve';
import {save_file, save_picture} from './save';
import {ScaleControl} from './scale_control';
import {cut, toggle_section} from './section';
import {Shading, type Shown} from './shading';
import {shared, shared_controls, with_state, type SharedState} from './shared';
import {Space} from './space';
import {toolbar} from './toolbar';
import {Viewpoint} from './camera';
import {Views} from './views';
import {WhatIf} from './what_if';

performance.mark('script');
const asked_state = load_state(), asked_facts = load_facts();
asked_facts.catch(() => {});  // told below; of a running solve there are none yet
const canvas = by_id<HTMLCanvasElement>('picture'), place = by_id('view');
if (window.innerWidth <= 760) document.body.classList.add('alone');
const renderer = new THREE.WebGLRenderer({canvas, antialias: true, preserveDrawingBuffer: true});
renderer.outputColorSpace = THREE.LinearSRGBColorSpace;  // the shader encodes by itself, as `render` does
size_picture();
performance.mark('renderer');
const chosen = new THREE.Group(), shooters = new THREE.Group(), marks = new THREE.Group();
marks.add(chosen, shooters);
let facts: Facts, shading: Shading, panes: Panes, view: Viewpoint, space: Space | null = null, objects: Objects, compare: Compare | null = null, views: Views;
let wanted = true, told_panes = '';
let files: [string, string] | null = null, exposure = 1, labelled = '', ranged = '', range: [number, number] = [0, 1], rested = 0, hovered: [number, number] | null = null;

const redraw = () => { wanted = true; };
const width = () => Math.max(1, place.clientWidth), height = () => Math.max(1, place.clientHeight);
const scale = new ScaleControl(() => panes && apply(), () => { ranged = ''; if (panes) apply(); });
const card = new Card({
    hide: group => { objects.hide(group); card.close(); }, isolate: group => objects.isolate(group),
    copied: words => { void navigator.clipboard.writeText(words); },
});
const line = new LineTool(card, chosen, redraw);
const unit = () => facts.units.irradiance;
const show_section = () => { cut(facts, shading); redraw(); };

function paint(): void {
    const sky = getComputedStyle(document.documentElement).getPropertyValue('--sky').trim();
    renderer.setClearColor(new THREE.Color().setStyle(sky, THREE.LinearSRGBColorSpace));  // as it is, since nothing encodes it
    panes.draw(renderer, view, width(), height(), box('mesh').checked);
    if (panes.sources().map(s => panes.words(s)).join() !== told_panes) show_panes();
    const first = panes.panes(width())[0];
    card.follow(view.camera, first.view_left, first.view_width, height());
}

function draw(last: number): void {
    requestAnimationFrame(now => {
        if (view.fly((now - last) / 1000)) redraw();
        view.keep();
        if (wanted) { wanted = false; paint(); }
        label_lines(now);
        show_hover();
        draw(now);
    });
}

/** Numbers at the isolines, once the camera has rested; none while it moves. */
function label_lines(now: number): void {
    const words = JSON.stringify([view.words(), width(), height(), shading.seen, shading.steps, box('isolux').checked, choice('quantity'), panes.change]);
    if (words !== labelled) { labelled = words, rested = now; clear_labels(); }
    if (rested === 0 || now - rested < 250 || view.dragging) return;
    rested = 0;
    if (!box('isolux').checked || choice('quantity') === 'radiosity' || panes.arrangement !== 'one') return;
    show_labels(shading.steps, width(), height(), (x, y) => {
        const found = panes.hit(x, y, width(), height(), view);
        return found && {value: found.value, object: found.group, normal: found.hit.face!.normal, point: found.hit.point};
    });
}

function show_hover(): void {
    if (!hovered || !panes || view.dragging) return;
    const [x, y] = hovered, pair = panes.compared(x, y, width(), height(), view), found = panes.hit(x, y, width(), height(), view);
    hovered = null;
    if (pair) card.show_hover(x, y, compare!.words(pair));
    else card.show_hover(x, y, found ? `${short(found.value)} ${unit()}` : null);
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

/** The range of the light in the picture, found again when other light is shown, but not while the camera moves. */
function visible_range(radiosity: boolean): [number, number] {
    const words = JSON.stringify([radiosity, panes.change, panes.source, panes.arrangement, panes.layers.delivered.progress]);
    if (words === ranged) return range;
    ranged = words;
    return range = panes.layers.delivered.range(radiosity, panes.visible_values(width(), height(), view, radiosity));
}

/** Everything that the settings say. */
function apply(): void {
    const shown = choice('quantity') as Shown, stops = Number(box('exposure').value), isolux = box('isolux').checked;
    const values = shown === 'radiosity' || shown === 'irradiance';
    shading.show(shown, isolux, values ? scale.threshold : -1);
    shading.uniforms.curve.value = Number(choice('tone'));
    shading.uniforms.scale.value = exposure * 2 ** stops;
    by_id('exposure_text').textContent = `${stops >= 0 ? '+' : ''}${stops.toFixed(1)} stops`;
    by_id('values').hidden = !values && !isolux;
    by_id('threshold_unit').textContent = unit();
    if (values || isolux) shading.set_steps(scale.steps(visible_range(shown === 'radiosity')), scale.palette);
    if (panes.arrangement === 'difference') compare!.set_steps(() => {
        view.resize(width() / height());
        return panes.most_difference(view, shown === 'radiosity');
    }, shown === 'radiosity');
    by_id('tool_colours').setAttribute('aria-pressed', String(values));
    by_id('tool_isolux').setAttribute('aria-pressed', String(isolux));
    show_legend({facts, shading, panes, compare, shown, isolux, threshold: scale.threshold});
    redraw();
}

/** Names of the panes, and the dividers between them. */
function show_panes(): void {
    if (!panes) return;
    const all = panes.panes(width()), split = panes.arrangement === 'split';
    const named = all.filter(p => p.right - p.left > 30 && (all.length > 1 || (p.source !== 'best' && !/^\w+$/.test(panes.words(p.source)))));
    told_panes = all.map(p => panes.words(p.source)).join();
    by_id('panes').replaceChildren(...named.map(p => {
        const name = make('span', panes.words(p.source));
        name.style.left = `${p.left + 10}px`;
        return name;
    }));
    document.querySelectorAll<HTMLElement>('.divider').forEach((divider, i) => {
        const at = divider.id === 'half' ? panes.half : panes.dividers[i];
        divider.hidden = divider.id === 'half' ? panes.arrangement !== 'halves' : !split;
        divider.style.left = `${at * width()}px`;
        divider.setAttribute('aria-valuenow', String(Math.round(100 * at)));
    });
    redraw();
}

async function arrange(): Promise<void> {
    panes.arrangement = compare?.arrangement ?? choice('arrangement') as Arrangement;
    panes.source = choice('source') as Source;
    by_id<HTMLSelectElement>('source').disabled = panes.arrangement !== 'one';
    by_id<HTMLSelectElement>('arrangement').disabled = panes.other !== null;
    show_panes();
    try { await panes.load(); } catch (error) { card.tell(String(error)); }
    if (panes.sources().includes('raw')) document.body.dataset.raw = '1';
    apply();
}

function move_divider(i: number, to: number): void {
    const d = panes.dividers;
    if (i > 1) panes.half = Math.min(Math.max(to, 0), 1);
    else d[i] = Math.min(Math.max(to, i === 0 ? 0 : d[0]), i === 0 ? d[1] : 1);
    show_panes();
}

/** The light at a point that somebody chose: the exact one from the program, the interpolated one in a shared page. */
async function light_at(found: Found): Promise<Light> {
    const {point, face} = found.hit;
    if (shared) return {irradiance: found.light!, material: found.material, group: facts.groups[found.group]};
    return load_point([...point.toArray(), ...face!.normal.toArray()], found.change);
}

async function pick(x: number, y: number): Promise<void> {
    const found = panes.hit(x, y, width(), height(), view);
    if (!found || !found.hit.face) { line.in_use ? card.tell('There is nothing. Click on a surface.') : card.close(); return; }
    const point = found.hit.point, normal = found.hit.face.normal;
    try {
        if (line.in_use) return await line.add_end(point, normal, unit(), panes.change);
        const light = await light_at(found);
        chosen.clear();
        if (box('mesh').checked || panes.source === 'raw') draw_outlines(chosen, [found.outline], 0xff7a1a);
        const linked = (light.links ?? []).map(l => l.outline.map(p => new THREE.Vector3(...p)));
        draw_outlines(chosen, linked, 0x2f7de1);
        draw_outlines(chosen, linked.map(corners => [point, corners.reduce((sum, p) => sum.add(p), new THREE.Vector3()).divideScalar(corners.length)]),
            0x2f7de1, false);
        card.show_hover(0, 0, null);
        const number = (bands: Triple) => bands.reduce((sum, band, c) => sum + facts.weights[c] * band, 0);
        card.show(light, point, number, unit(), found.group);
        redraw();
    } catch (error) { card.tell(String(error)); }
}

function show_facts(): void {
    by_id('name').textContent = facts.file.split('/').pop() ?? 'exitance';
    by_id('facts').textContent = `${facts.surfaces} faces` + (facts.error === null ? '' : `; light accurate to about ${(100 * facts.error).toPrecision(2)}%`);
    by_id('method').textContent = `Method ${facts.method}, ${facts.basis} basis, ${facts.elements} elements` +
        (facts.error === null ? '.' : `; estimated error ${(100 * facts.error).toPrecision(2)}%.`);
    const classes = by_id<HTMLSelectElement>('quantity').querySelector<HTMLOptionElement>('[value=classes]')!;
    classes.hidden = classes.disabled = !facts.shadow_classes;
    const options = by_id<HTMLSelectElement>('quantity').options;
    options[1].text = title_of(facts, false), options[2].text = title_of(facts, true);
}

function show_overview(): void {
    const [eye, target, fov] = overview(renderer, panes, view, facts);
    view.set(eye, target, fov);
    view.to_address();
    redraw();
}

function enter_room(): void {
    view.set(facts.camera.eye, facts.camera.target, facts.camera.fov);
    view.to_address();
    redraw();
}

/** What is there for the first time: the camera, the saved views, the loop that draws. */
function begin(): void {
    view = new Viewpoint(facts, canvas, () => space, redraw);
    performance.mark('viewpoint');
    views = new Views(facts.file.split('/').pop() ?? '', shared && shared.views, camera => { if (view.from_words(camera)) redraw(); });
    by_id('save_view').addEventListener('click', () => views.add(view.words()));
    by_id('views_save').addEventListener('click', () => save_file('views.json', 'application/json', views.text()));
    by_id('views_load').addEventListener('click', () => box('views_file').click());
    box('views_file').addEventListener('change', () => {
        void box('views_file').files?.[0]?.text().then(text => { if (!views.read(text)) card.tell('The file holds no views.'); });
    });
    show_panes();
    draw(performance.now());
}

async function load(first: boolean, known: Facts | null = null): Promise<void> {
    facts = known ?? await load_facts();
    performance.mark('facts');
    const old = panes, old_objects = objects;
    shading = new Shading(facts);
    const fresh: Panes = new Panes(facts, shading, marks, redraw);
    if (old) [fresh.source, fresh.dividers, fresh.half] = [old.source, old.dividers, old.half];
    if (old) fresh.arrangement = choice('arrangement') as Arrangement, compare = null;
    exposure = facts.exposure, ranged = '';
    // What was there stays in sight until there is something new.
    await fresh.layers.delivered.load(fresh.change, () => {
        performance.mark('buffers');
        if (panes !== fresh) {
            panes = fresh;
            old?.dispose();
            if (first) begin();
            show_facts();
            objects = new Objects(facts, hidden => { shading.hide(hidden); redraw(); });
            if (old_objects) objects.restore(old_objects);
            objects.show();
            show_section();
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
    space = new Space(panes.layers.delivered);
    view.find_place();
    apply();
    if (shared) show_shared();
    document.body.dataset.ready = '1';
    await new WhatIf(facts, panes, shading, apply).show();
    compare = new Compare(panes, shading, facts, () => void arrange());
    document.body.dataset.whatif = '1';
    await compare.show(!by_id('change_section').hidden, files);
}

/** What the page shows, for a page that is passed on. */
function present_state(): SharedState {
    const controls = Object.fromEntries(shared_controls.map(id => [id, box(id).type === 'checkbox' ? box(id).checked : box(id).value]));
    return {camera: view.words(), controls, range: scale.choice, exposure, hidden: objects.hidden_groups, factors: shading.dimmed,
        reflectances: shading.reflectances};
}

/** The state in which this page was shared. What only the program can answer is left out. */
function show_shared(): void {
    for (const id of ['share', 'how_section', 'exposure_auto']) by_id(id).hidden = true;
    const state = shared!.state;
    if (!state) { if (shared!.views.length > 0) view.from_words(shared!.views[0].camera); return redraw(); }
    for (const [id, value] of Object.entries(state.controls))
        if (typeof value === 'boolean') box(id).checked = value; else box(id).value = value;
    exposure = state.exposure, scale.choice = state.range;
    shading.dim(state.factors);
    shading.paint(state.reflectances);
    objects.hidden_groups = state.hidden;
    if (!location.hash) view.from_words(state.camera);
    show_section();
    apply();
}

async function share(): Promise<void> {
    card.tell('The page is made.');
    try {
        const page = with_state(await load_share(panes.change), present_state(), views.list);
        save_file((facts.file.split('/').pop() ?? 'room').replace(/\.\w+$/, '') + '.html', 'text/html', page);
        card.close();
    } catch (error) { card.tell(String(error)); }
}

function toggle(id: string): void { box(id).checked = !box(id).checked; apply(); }

function toggle_panel(): void {
    document.body.classList.toggle('alone');
    by_id('tool_panel').setAttribute('aria-pressed', String(!document.body.classList.contains('alone')));
    if (view) resize();
}

function toggle_colours(): void {
    const select = by_id<HTMLSelectElement>('quantity');
    select.value = select.value === 'irradiance' ? 'picture' : 'irradiance';
    apply();
}

const tools: Record<string, [string, () => void]> = {
    tool_panel: ['h', toggle_panel], tool_value: ['v', () => line.use(false)], tool_line: ['l', () => line.use(!line.in_use)],
    tool_section: ['x', () => { toggle_section(); show_section(); }], tool_colours: ['r', toggle_colours], tool_isolux: ['i', () => toggle('isolux')],
    fit: ['f', show_overview], enter: ['g', enter_room], save_view: ['b', () => {}],
    share: ['t', () => void share()],
    save_picture: ['p', () => { paint(); save_picture(canvas, by_id('legend'), by_id('labels'), (facts.file.split('/').pop() ?? 'picture').replace(/\.\w+$/, '') + '.png'); }],
};
for (const [id, [, act]] of Object.entries(tools)) by_id(id).addEventListener('click', () => { if (panes) act(); });
toolbar(by_id('bar'));
by_id('tool_panel').setAttribute('aria-pressed', String(!document.body.classList.contains('alone')));
for (const id of ['quantity', 'tone', 'exposure', 'mesh', 'isolux']) by_id(id).addEventListener('input', () => panes && apply());
for (const id of ['source', 'arrangement']) by_id(id).addEventListener('input', () => panes && void arrange());
for (const id of ['cut_axis', 'cut_at', 'cut_flip']) by_id(id).addEventListener('input', () => panes && show_section());
by_id('objects_all').addEventListener('click', () => objects?.show_all());
by_id('exposure_auto').addEventListener('click', () => void load_facts(panes.change).then(now => {
    exposure = now.exposure, box('exposure').value = '0';
    apply();
}));
by_id('record').addEventListener('click', () => {
    view.record();
    by_id('record').textContent = view.recording ? 'Stop recording' : 'Record path';
    for (const id of ['replay', 'save_path']) by_id(id).hidden = view.recording || view.path.length === 0;
});
by_id('replay').addEventListener('click', () => view.replay());
by_id('save_path').addEventListener('click', () => save_file('path.csv', 'text/csv', view.path_text()));
document.querySelectorAll<HTMLElement>('.divider').forEach((divider, i) => {
    divider.addEventListener('pointerdown', event => divider.setPointerCapture(event.pointerId));
    divider.addEventListener('pointermove', event => {
        if (divider.hasPointerCapture(event.pointerId)) move_divider(i, (event.clientX - place.getBoundingClientRect().left) / width());
    });
    divider.addEventListener('keydown', event => {
        const step = (event.shiftKey ? 0.05 : 0.01) * (event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0);
        if (step !== 0) { event.preventDefault(); move_divider(i, (i > 1 ? panes.half : panes.dividers[i]) + step); }
    });
});
let pressed: [number, number] = [0, 0];
canvas.addEventListener('pointerdown', event => { pressed = [event.clientX, event.clientY]; card.show_hover(0, 0, null); canvas.focus(); });
canvas.addEventListener('pointerup', event => {
    if (panes && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 4) void pick(event.offsetX, event.offsetY);
    redraw();
});
canvas.addEventListener('pointermove', event => { if (event.buttons === 0 && event.pointerType !== 'touch') hovered = [event.offsetX, event.offsetY]; });
canvas.addEventListener('pointerleave', () => { hovered = null; card.show_hover(0, 0, null); });
canvas.addEventListener('keyup', event => {
    if (!panes || event.ctrlKey || event.metaKey) return;
    const key = event.key.toLowerCase();
    const tool = Object.entries(tools).find(([, [k]]) => k === key && k !== 'h');
    if (tool) by_id(tool[0]).click();
    if (key === 'm') toggle('mesh');
    if (key === 'k') compare?.keep();
    if (key === 'escape') { line.use(false); chosen.clear(); redraw(); }
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
    if (event.key.toLowerCase() === 'h' && !event.ctrlKey && !typing) toggle_panel();
    if (event.key === 'Escape' && event.target !== canvas && card.open) { card.close(); canvas.focus(); }
});
window.addEventListener('resize', () => view && resize());
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
const debug = renderer.getContext().getExtension('WEBGL_debug_renderer_info');
const processor = debug ? String(renderer.getContext().getParameter(debug.UNMASKED_RENDERER_WEBGL)) : '';
by_id('software').hidden = !/swiftshader|llvmpipe|software|basic render/i.test(processor);

asked_state.then(async (state: State) => {
    files = state.files;
    return state.solving ? follow_solve(shooters, redraw, load) : load(true, await asked_facts);
})
    .catch(error => { by_id('facts').textContent = String(error); });
// What tests of the page ask for.
Object.assign(window, {exitance: {words: () => view.words(), exposure: () => shading.uniforms.scale.value as number,
    size: () => [width(), height()], canvas: () => { paint(); return canvas.toDataURL(); }, whole: () => panes.whole,
    inside: () => view.inside, back_share: () => panes.back_share(width(), height(), view), look: (words: string) => { view.from_words(words); redraw(); }, round_steps}});
