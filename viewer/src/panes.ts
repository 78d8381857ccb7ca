// Which light is shown where: one picture, a split one whose dividers move, or three beside one another, by one camera.
// best: the continuous function while one moves, then the exact picture; raw: what the method's elements hold;
// delivered: the continuous function made of them; exact: direct light exact in every pixel, as `render` draws it.
// other: continuous light of another solution, or as it was with other lamps and materials; difference: the present light
// minus the other.
import * as THREE from 'three';
import {load_frame, Refused, unchanged, type Change, type Facts, type Triple} from './data';
import {Elements} from './elements';
import {shared} from './shared';
import {same_place, type Shading} from './shading';
import type {Viewpoint} from './camera';

export type Source = 'best' | 'delivered' | 'raw' | 'exact' | 'method' | 'other' | 'difference';
export type Arrangement = 'one' | 'split' | 'panes' | Comparison;
/** How two lights are compared: with a divider, side by side, or by their difference in false colours. */
export type Comparison = 'halves' | 'beside' | 'difference';
/** Light to compare with; `name` is shown, `change` is how the program is asked for it. */
export interface Other { name: string; change: Change; facts: Facts; elements: Elements; shading: Shading }
/** Of the canvas, in CSS pixels from its left edge: what is drawn there, and where the camera's picture begins and ends. */
export interface Pane { source: Source; left: number; right: number; view_left: number; view_width: number }
export interface Found { hit: THREE.Intersection; outline: THREE.Vector3[]; value: number; group: number; change: Change; light: Triple | null; material: string }

const order: Source[] = ['raw', 'delivered', 'exact'];
const still = 150;   // milliseconds without a movement, after which the exact picture is taken
const coarse = 4;    // a compared picture while one moves has so many times fewer pixels across
/** Pixels at which a ray is tried: a ray exactly along the corner of two walls may pass between them. */
const around = [[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]];
const visible_columns = 48, visible_rows = 32;  // rays that find the range of the visible light
const fading = 300;  // milliseconds in which the exact picture appears

export class Panes {
    readonly layers: Record<'delivered' | 'raw' | 'method', Elements>;
    arrangement: Arrangement = 'one';
    source: Source = 'best';
    dividers: [number, number] = [1 / 3, 2 / 3];
    half = 0.5;
    change: Change = unchanged;
    other: Other | null = null;
    /** Name of the present light, where it is compared. */
    name = 'now';
    private targets: THREE.WebGLRenderTarget[] = [];
    private stage = new THREE.Scene();
    private quad: THREE.Mesh;
    private sheet = new THREE.Scene();
    private sheet_camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);
    private in_flight = false;
    private frame_of = '';
    private moved = 0;
    private appeared = 0;
    private last_words = '';
    /** What there is of the exact picture of this camera. */
    private exact: 'nothing' | 'coarse' | 'full' = 'nothing';

    constructor(private facts: Facts, private shading: Shading, private extra: THREE.Object3D, private changed: () => void) {
        this.layers = {delivered: new Elements(facts, shading, 'exported'), raw: new Elements(facts, shading, 'raw'),
            method: new Elements(facts, shading, 'method')};
        for (const e of Object.values(this.layers)) this.stage.add(e.whole, e.lines);
        this.stage.add(extra);
        this.quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), shading.frame);
        this.quad.frustumCulled = false;
        this.sheet.add(this.quad);
    }

    /** Takes other light to compare with; null: none. */
    compare_with(other: Other | null): void {
        if (this.other) this.stage.remove(this.other.elements.whole, this.other.elements.lines);
        this.other = other;
        if (other) this.stage.add(other.elements.whole, other.elements.lines);
        this.shading.lead(other?.shading ?? null);
    }

    /** The present light as it is, under a name. */
    kept(name: string): Other {
        const shading = this.shading.make_twin(this.facts);
        return {name, change: this.change, facts: this.facts, elements: this.layers.delivered.kept(shading), shading};
    }

    private all(): Elements[] { return [...Object.values(this.layers), ...this.other ? [this.other.elements] : []]; }

    /** The sources in sight. */
    sources(): Source[] {
        const of: Record<Arrangement, Source[]> = {one: [this.source], split: order, panes: order, halves: ['delivered', 'other'],
            beside: ['delivered', 'other'], difference: ['difference']};
        return of[this.arrangement];
    }

    private is_exact(source: Source): boolean { return source === 'exact' || source === 'best'; }
    private layer(source: Source): Elements {
        if (source === 'other' && this.other) return this.other.elements;
        return this.layers[source === 'raw' || source === 'method' ? source : 'delivered'];
    }

    /** The program's pictures show all faces: there is none where some are hidden, cut away or seen from behind, or no program. */
    private has_exact(): boolean {
        const {backs, hidden, cut} = this.shading.seen;
        return backs && hidden.length === 0 && cut === null && !shared;
    }

    /** True if the picture of this camera is as exact as it becomes. */
    get whole(): boolean { return !this.has_exact() || this.exact === 'full' && performance.now() - this.appeared >= fading; }

    /** What is shown of a source, in words. */
    words(source: Source): string {
        const titles = {raw: "method's elements", delivered: 'continuous', exact: 'exact', method: 'reflected', best: 'exact',
            other: this.other?.name ?? '', difference: `${this.name} minus ${this.other?.name}`};
        if (source === 'delivered' && this.sources().includes('other')) return this.name;
        if (!this.is_exact(source)) return titles[source] + this.layer(source).progress;
        return titles.exact + {nothing: ': being drawn', coarse: ': being drawn', full: ''}[this.exact];
    }

    /** Loads what is in sight, the delivered light always: rays of the pointer meet it. */
    async load(): Promise<void> {
        await this.layers.delivered.load(this.change, this.changed);
        for (const source of this.sources())
            if (!this.is_exact(source)) await this.layer(source).load(this.change, this.changed);
    }

    async refill(change: Change): Promise<void> {
        this.change = change;
        this.frame_of = '';
        this.exact = 'nothing';
        await this.layers.delivered.refill(change);
        for (const source of ['raw', 'method'] as const) {
            if (this.sources().includes(source)) await this.layers[source].refill(change);
            else this.layers[source].stale = true;
        }
        this.drop_frame();
        this.changed();
    }

    dispose(): void {
        for (const e of this.all()) e.dispose();
        for (const target of this.targets) target.dispose();
        this.drop_frame();
    }

    /** Where what is drawn, in CSS pixels. */
    panes(width: number): Pane[] {
        if (this.arrangement === 'one') return [{source: this.source, left: 0, right: width, view_left: 0, view_width: width}];
        const ends = {one: [0, 1], difference: [0, 1], split: [0, ...this.dividers, 1], panes: [0, 1 / 3, 2 / 3, 1], halves: [0, this.half, 1],
            beside: [0, 0.5, 1]}[this.arrangement], whole = this.arrangement === 'split' || this.arrangement === 'halves';
        return this.sources().map((source, i) => {
            const left = Math.round(ends[i] * width), right = Math.round(ends[i + 1] * width);
            return {source, left, right, view_left: whole ? 0 : left, view_width: whole ? width : right - left};
        });
    }

    draw(renderer: THREE.WebGLRenderer, view: Viewpoint, width: number, height: number, lines: boolean): void {
        this.shading.see_backs(view.inside);
        this.shading.leave_room_for_lines(lines || this.extra.children.some(group => group.children.length > 0));
        for (const e of this.all()) e.shade();
        this.quad.material = this.shading.frame;
        if (this.arrangement === 'difference') { this.draw_difference(renderer, view, width, height); return; }
        renderer.setScissorTest(this.arrangement !== 'one');
        const all = this.panes(width);
        view.resize(all[0].view_width / height);
        if (this.sources().some(s => this.is_exact(s))) this.ask_frame(view, all[all.length - 1].view_width, height, renderer.getPixelRatio());
        renderer.autoClear = false;
        for (const pane of all) {
            if (pane.right <= pane.left) continue;
            renderer.setViewport(pane.view_left, 0, pane.view_width, height);
            renderer.setScissor(pane.left, 0, pane.right - pane.left, height);
            renderer.clear();
            this.draw_pane(renderer, view, pane.source, lines);
        }
    }

    /** Elements, the exact picture over them where it is there, and lines over both. */
    private draw_pane(renderer: THREE.WebGLRenderer, view: Viewpoint, source: Source, lines: boolean): void {
        const layer = this.layer(source);
        this.show_layer(layer, lines);
        renderer.render(this.stage, view.camera);
        if (!this.is_exact(source) || this.shading.uniforms.light.value === null) return;
        const shown = source === 'best' ? Math.min(1, (performance.now() - this.appeared) / fading) : 1;
        this.shading.uniforms.opacity.value = shown;
        if (shown < 1) requestAnimationFrame(this.changed);
        renderer.render(this.sheet, this.sheet_camera);
        layer.whole.visible = false;
        renderer.render(this.stage, view.camera);
    }

    private show_layer(layer: Elements, lines: boolean): void {
        for (const e of this.all()) {
            e.whole.visible = e === layer;
            e.show_lines(lines && e === layer);
        }
    }

    /** Values of both lights as pictures of numbers, and the colours of their difference. */
    private draw_difference(renderer: THREE.WebGLRenderer, view: Viewpoint, width: number, height: number): void {
        const size = [width, height].map(x => Math.max(1, Math.round(x * renderer.getPixelRatio())));
        const clear = renderer.getClearColor(new THREE.Color()).clone(), pair = [this.layers.delivered, this.layer('other')];
        while (this.targets.length < 2)
            this.targets.push(new THREE.WebGLRenderTarget(1, 1, {type: THREE.FloatType, minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter}));
        view.resize(width / height);
        renderer.setScissorTest(false);
        renderer.autoClear = false;
        renderer.setClearColor(0, 0);
        this.extra.visible = false;
        pair.forEach((layer, i) => {
            this.targets[i].setSize(size[0], size[1]);
            this.show_layer(layer, false);
            layer.shade(true);
            renderer.setRenderTarget(this.targets[i]);
            renderer.clear();
            renderer.render(this.stage, view.camera);
            layer.shade();
        });
        this.extra.visible = true;
        renderer.setRenderTarget(null);
        renderer.setClearColor(clear, 1);
        renderer.setViewport(0, 0, width, height);
        renderer.clear();
        this.shading.uniforms.present.value = this.targets[0].texture, this.shading.uniforms.other.value = this.targets[1].texture;
        this.quad.material = this.shading.difference;
        renderer.render(this.sheet, this.sheet_camera);
    }

    /** A picture of the elements alone from any camera, for tests of what a view would show. */
    draw_preview(renderer: THREE.WebGLRenderer, camera: THREE.Camera, backs: boolean): void {
        this.shading.see_backs(backs);
        this.show_layer(this.layers.delivered, false);
        this.layers.delivered.shade();
        renderer.clear();
        renderer.render(this.stage, camera);
    }

    /**
     * Asks for the exact picture of this camera. One that is compared with others is there while the camera moves, too,
     * but coarse. When the camera rests, one ray a pixel comes first, then four.
     */
    private ask_frame(view: Viewpoint, width: number, height: number, ratio: number): void {
        const {seen} = this.shading;
        if (!this.has_exact()) return this.drop_frame();
        const words = JSON.stringify([view.words(), width, height, seen]), now = performance.now();
        if (words !== this.last_words) {
            this.drop_frame();
            this.last_words = words, this.moved = now, this.frame_of = '';
        }
        const rests = now - this.moved >= still && !view.dragging, follows = this.arrangement !== 'one';
        if (!rests) window.setTimeout(this.changed, still);
        if (!rests && !follows) return;
        const full = rests && this.exact !== 'nothing', scale = rests ? ratio : ratio / coarse, samples = full ? 4 : 1;
        const size = [width, height].map(x => Math.max(1, Math.round(x * scale)));
        const wanted = words + size + samples + this.change.dim + this.change.paint;
        if (wanted === this.frame_of || this.exact === 'full' || this.in_flight) return;
        this.frame_of = wanted;
        void this.take_frame(words, view.numbers(), size, samples, full);
    }

    private async take_frame(words: string, camera: number[], size: number[], samples: number, full: boolean): Promise<void> {
        const change = this.change;
        this.in_flight = true;
        try {
            const frame = await load_frame(camera, size[0], size[1], samples, change);
            if (this.last_words !== words || this.change !== change) return;
            const texture = (data: Float32Array, format: THREE.PixelFormat) => {
                const t = new THREE.DataTexture(data, frame.width, frame.height, format, THREE.FloatType);
                t.needsUpdate = true;
                return t;
            };
            const first = this.exact === 'nothing';
            this.drop_frame();
            if (first) this.appeared = performance.now();
            this.shading.uniforms.light.value = texture(frame.light, THREE.RGBAFormat);
            this.shading.uniforms.rest.value = texture(frame.rest, THREE.RGFormat);
            this.exact = full ? 'full' : 'coarse';
            this.changed();
        } catch (error) {
            if (!(error instanceof Refused && error.status === 409)) console.warn(String(error));
        } finally {
            this.in_flight = false;
            this.changed();
        }
    }

    private drop_frame(): void {
        this.exact = 'nothing';
        for (const name of ['light', 'rest']) {
            (this.shading.uniforms[name].value as THREE.Texture | null)?.dispose();
            this.shading.uniforms[name].value = null;
        }
    }

    /** What is under a place of the canvas, in CSS pixels. */
    hit(x: number, y: number, width: number, height: number, view: Viewpoint): Found | null {
        const pane = this.panes(width).find(p => x >= p.left && x <= p.right);
        if (!pane) return null;
        const layer = this.layer(pane.source), ray = new THREE.Raycaster();
        for (const [dx, dy] of around) {
            const at = new THREE.Vector2(2 * (x + dx - pane.view_left) / pane.view_width - 1, 1 - 2 * (y + dy) / height);
            ray.setFromCamera(at, view.camera);
            const is_other = pane.source === 'other' && this.other !== null, hit = layer.hit(ray, (is_other ? this.other!.shading : this.shading).seen);
            if (!hit) continue;
            // Objects of the other light are those of the same name.
            const number = layer.group(hit), named = is_other ? this.facts.groups.indexOf(this.other!.facts.groups[number] ?? '') : number;
            return {hit, outline: layer.outline(hit), value: layer.value(hit), group: named < 0 ? this.facts.groups.length : named,
                change: is_other ? this.other!.change : this.change, light: layer.light(hit), material: layer.material(hit)};
        }
        return null;
    }

    /** Present and other light where a ray of the camera meets the same surface in both; null where it does not. */
    private pair(ray: THREE.Raycaster, radiosity: boolean, emitters: boolean): [number, number] | null {
        if (!this.other) return null;
        const {delivered} = this.layers, {elements, shading} = this.other, a = delivered.hit(ray, this.shading.seen), b = elements.hit(ray, shading.seen);
        if (!a || !b || Math.abs(a.distance - b.distance) > same_place * Math.max(a.distance, b.distance)) return null;
        if (emitters) return [delivered.value(a), elements.value(b)];
        const [p, q] = [delivered.shown_value(a, radiosity), elements.shown_value(b, radiosity)];
        return p === null || q === null ? null : [p, q];
    }

    /** Both lights under a place of the canvas, in CSS pixels; null where they are not compared. */
    compared(x: number, y: number, width: number, height: number, view: Viewpoint): [number, number] | null {
        const pane = this.panes(width).find(p => x >= p.left && x <= p.right);
        if (!pane || !['halves', 'beside', 'difference'].includes(this.arrangement)) return null;
        const ray = new THREE.Raycaster();
        ray.setFromCamera(new THREE.Vector2(2 * (x - pane.view_left) / pane.view_width - 1, 1 - 2 * y / height), view.camera);
        return this.pair(ray, false, true);
    }

    /** The 98th percentile of the differences in the picture, from rays through a coarse grid of pixels; without sources. */
    most_difference(view: Viewpoint, radiosity: boolean): number {
        const found: number[] = [], ray = new THREE.Raycaster();
        for (let k = 0; k < visible_rows; ++k)
            for (let i = 0; i < visible_columns; ++i) {
                ray.setFromCamera(new THREE.Vector2((2 * i + 1) / visible_columns - 1, (2 * k + 1) / visible_rows - 1), view.camera);
                const pair = this.pair(ray, radiosity, false);
                if (pair) found.push(Math.abs(pair[0] - pair[1]));
            }
        return found.sort((a, b) => a - b)[Math.floor(0.98 * found.length)] ?? 0;
    }

    /** Share of the picture in which backs of faces are seen, by rays through a coarse grid of pixels. For tests. */
    back_share(width: number, height: number, view: Viewpoint): number {
        const layer = this.layer(this.panes(width)[0].source), ray = new THREE.Raycaster();
        let backs = 0;
        for (let k = 0; k < visible_rows; ++k)
            for (let i = 0; i < visible_columns; ++i) {
                ray.setFromCamera(new THREE.Vector2((2 * i + 1) / visible_columns - 1, (2 * k + 1) / visible_rows - 1), view.camera);
                const normal = layer.hit(ray, this.shading.seen)?.face?.normal;
                if (normal && normal.dot(ray.ray.direction) > 0) ++backs;
            }
        return backs / (visible_rows * visible_columns);
    }

    /**
     * The light of the surfaces in the camera's picture, one number each from rays through a coarse grid of pixels; without
     * sources. Sorted.
     */
    visible_values(width: number, height: number, view: Viewpoint, radiosity: boolean): number[] {
        const pane = this.panes(width)[0], layer = this.layer(pane.source), ray = new THREE.Raycaster(), values: number[] = [];
        view.resize(pane.view_width / height);
        for (let k = 0; k < visible_rows; ++k)
            for (let i = 0; i < visible_columns; ++i) {
                ray.setFromCamera(new THREE.Vector2((2 * i + 1) / visible_columns - 1, (2 * k + 1) / visible_rows - 1), view.camera);
                const hit = layer.hit(ray, this.shading.seen), value = hit && layer.shown_value(hit, radiosity);
                if (value !== null) values.push(value);
            }
        return values.sort((a, b) => a - b);
    }
}
