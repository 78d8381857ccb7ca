// Which light is shown where: one picture, a split one whose dividers move, or three beside one another, by one camera.
// raw: what the method's elements hold; delivered: the continuous function made of them; exact: direct light exact in
// every pixel, as `render` draws it.
import * as THREE from 'three';
import {load_frame, Newest, unchanged, type Change, type Facts} from './data';
import {Elements} from './elements';
import type {Shading} from './shading';
import type {Viewpoint} from './camera';

export type Source = 'delivered' | 'raw' | 'exact' | 'method';
export type Arrangement = 'one' | 'split' | 'panes';
/** Of the canvas, in CSS pixels from its left edge: what is drawn there, and where the camera's picture begins and ends. */
export interface Pane { source: Source; left: number; right: number; view_left: number; view_width: number }

const order: Source[] = ['raw', 'delivered', 'exact'];
const still = 120;  // milliseconds without a movement, after which the exact picture is taken in full
const coarse = 4;   // the picture while one moves has so many times fewer pixels across

export class Panes {
    readonly layers: Record<'delivered' | 'raw' | 'method', Elements>;
    arrangement: Arrangement = 'one';
    source: Source = 'delivered';
    dividers: [number, number] = [1 / 3, 2 / 3];
    change: Change = unchanged;
    private stage = new THREE.Scene();
    private quad: THREE.Mesh;
    private sheet = new THREE.Scene();
    private sheet_camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);
    private newest = new Newest();
    private frame_of = '';
    private moved = 0;
    private last_words = '';
    /** What there is of the exact picture of this camera. */
    private exact: 'nothing' | 'coarse' | 'full' = 'nothing';

    constructor(facts: Facts, private shading: Shading, extra: THREE.Object3D, private changed: () => void) {
        this.layers = {delivered: new Elements(facts, shading, 'exported'), raw: new Elements(facts, shading, 'raw'),
            method: new Elements(facts, shading, 'method')};
        for (const e of Object.values(this.layers)) this.stage.add(e.whole, e.lines);
        this.stage.add(extra);
        this.quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), shading.frame);
        this.quad.frustumCulled = false;
        this.sheet.add(this.quad);
    }

    /** The sources in sight. */
    sources(): Source[] { return this.arrangement === 'one' ? [this.source] : order; }

    /** What is shown of a source, in words. */
    words(source: Source): string {
        const titles = {raw: 'raw', delivered: 'delivered', exact: 'exact', method: 'reflected'};
        if (source !== 'exact') return titles[source] + this.layers[source].progress;
        return titles.exact + {nothing: ': is being drawn', coarse: ': coarse', full: ''}[this.exact];
    }

    /** Loads what is in sight, the delivered light always: rays of the pointer meet it. */
    async load(): Promise<void> {
        await this.layers.delivered.load(this.change, this.changed);
        for (const source of this.sources())
            if (source !== 'exact') await this.layers[source].load(this.change, this.changed);
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
        this.changed();
    }

    dispose(): void {
        for (const e of Object.values(this.layers)) e.dispose();
        this.drop_frame();
    }

    /** Where what is drawn, in CSS pixels. */
    panes(width: number): Pane[] {
        if (this.arrangement === 'one') return [{source: this.source, left: 0, right: width, view_left: 0, view_width: width}];
        const ends = this.arrangement === 'split' ? [0, ...this.dividers, 1] : [0, 1 / 3, 2 / 3, 1];
        return order.map((source, i) => {
            const left = Math.round(ends[i] * width), right = Math.round(ends[i + 1] * width), whole = this.arrangement === 'split';
            return {source, left, right, view_left: whole ? 0 : left, view_width: whole ? width : right - left};
        });
    }

    draw(renderer: THREE.WebGLRenderer, view: Viewpoint, width: number, height: number, lines: boolean): void {
        for (const e of Object.values(this.layers)) e.shade();
        this.quad.material = this.shading.frame;
        renderer.setScissorTest(this.arrangement !== 'one');
        const all = this.panes(width);
        view.resize(all[0].view_width / height);
        renderer.autoClear = false;
        for (const pane of all) {
            if (pane.right <= pane.left) continue;
            renderer.setViewport(pane.view_left, 0, pane.view_width, height);
            renderer.setScissor(pane.left, 0, pane.right - pane.left, height);
            renderer.clear();
            const exact = pane.source === 'exact' && this.shading.uniforms.light.value !== null;
            const layer = this.layers[pane.source === 'exact' ? 'delivered' : pane.source];
            for (const e of Object.values(this.layers)) {
                e.whole.visible = e === layer;
                e.show_lines(lines && e === layer);
            }
            if (exact) renderer.render(this.sheet, this.sheet_camera);
            this.shading.material.colorWrite = !exact;  // of elements below an exact picture depth alone counts
            renderer.render(this.stage, view.camera);
            this.shading.material.colorWrite = true;
        }
        if (this.sources().includes('exact')) this.ask_frame(view, all[all.length - 1].view_width, height, renderer.getPixelRatio());
    }

    /** Asks for the exact picture of this camera: a coarse one while it moves, a full one when it stands still. */
    private ask_frame(view: Viewpoint, width: number, height: number, ratio: number): void {
        const words = view.words() + width + 'x' + height, now = performance.now();
        if (words !== this.last_words) {
            if (this.last_words.split('x')[0] !== words.split('x')[0]) this.drop_frame();
            this.last_words = words, this.moved = now;
        }
        const rests = now - this.moved >= still, full = rests && this.exact !== 'nothing';
        const scale = full ? ratio : ratio / coarse, size = [width, height].map(x => Math.max(1, Math.round(x * scale)));
        const wanted = words + size + this.change.dim + this.change.paint;
        if (!rests) window.setTimeout(this.changed, still);
        if (wanted === this.frame_of || (!full && !this.newest.idle)) return;
        this.frame_of = wanted;
        const camera = view.numbers(), change = this.change;
        this.newest.ask(async () => {
            const frame = await load_frame(camera, size[0], size[1], full ? 4 : 1, change);
            if (this.last_words !== words) return;
            const texture = (data: Float32Array, format: THREE.PixelFormat) => {
                const t = new THREE.DataTexture(data, frame.width, frame.height, format, THREE.FloatType);
                t.needsUpdate = true;
                return t;
            };
            this.drop_frame();
            this.shading.uniforms.light.value = texture(frame.light, THREE.RGBAFormat);
            this.shading.uniforms.rest.value = texture(frame.rest, THREE.RGFormat);
            this.exact = full ? 'full' : 'coarse';
            this.changed();
        });
    }

    private drop_frame(): void {
        this.exact = 'nothing';
        for (const name of ['light', 'rest']) {
            (this.shading.uniforms[name].value as THREE.Texture | null)?.dispose();
            this.shading.uniforms[name].value = null;
        }
    }

    /** What is under a place of the canvas, in CSS pixels. */
    hit(x: number, y: number, width: number, height: number, view: Viewpoint): {hit: THREE.Intersection; outline: THREE.Vector3[]} | null {
        const pane = this.panes(width).find(p => x >= p.left && x <= p.right);
        if (!pane) return null;
        const layer = this.layers[pane.source === 'raw' || pane.source === 'method' ? pane.source : 'delivered'];
        const ray = new THREE.Raycaster();
        ray.setFromCamera(new THREE.Vector2(2 * (x - pane.view_left) / pane.view_width - 1, 1 - 2 * y / height), view.camera);
        const hit = ray.intersectObjects(layer.whole.children)[0];
        return hit && hit.face ? {hit, outline: layer.outline(hit)} : null;
    }
}
