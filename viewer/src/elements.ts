// The elements as three.js draws them, a part at a time.
import * as THREE from 'three';
import {load_part, type Facts, type Part} from './data';
import type {Shading} from './shading';

/** Of edges by the order of the discontinuity along them (CurveOrder): border, D0, D1, D2. */
const order_colours: Record<number, Triple3> = {0: [0.9, 0.9, 0.9], 1: [0.9, 0.1, 0.1], 2: [0.95, 0.6, 0.1], 3: [0.2, 0.5, 0.95]};
const plain: Triple3 = [0.25, 0.25, 0.28];
type Triple3 = [number, number, number];

interface Loaded { part: Part; mesh: THREE.Mesh; light: THREE.BufferAttribute }

export class Elements {
    readonly whole = new THREE.Group();
    readonly lines = new THREE.Group();
    private loaded: Loaded[] = [];

    constructor(private facts: Facts, private shading: Shading) {}

    async load(layer: 'exported' | 'method', changed: () => void): Promise<void> {
        const fresh: Loaded[] = [];
        const old = this.loaded;
        for (let i = 0; i < this.facts.parts[layer]; ++i) {
            const part = await load_part(layer, i);
            if (i === 0) this.clear(old);
            fresh.push(this.add(part));
            this.loaded = fresh;
            changed();
        }
    }

    private clear(old: Loaded[]): void {
        for (const {mesh} of old) mesh.geometry.dispose();
        for (const line of this.lines.children) (line as THREE.LineSegments).geometry.dispose();
        this.whole.clear();
        this.lines.clear();
    }

    private add(part: Part): Loaded {
        const geometry = new THREE.BufferGeometry();
        const light = new THREE.BufferAttribute(part.irradiance, 3);
        geometry.setAttribute('position', new THREE.BufferAttribute(part.positions, 3));
        geometry.setAttribute('irradiance', light);
        geometry.setAttribute('material', new THREE.BufferAttribute(Float32Array.from(part.materials), 1));
        geometry.setIndex(new THREE.BufferAttribute(part.triangles, 1));
        const mesh = new THREE.Mesh(geometry, this.shading.material);
        this.whole.add(mesh);
        const ends = new Float32Array(3 * part.edges.length), colours = new Float32Array(3 * part.edges.length);
        part.edges.forEach((v, i) => {
            const colour = order_colours[part.orders[i >> 1]] ?? plain;
            for (let c = 0; c < 3; ++c) ends[3 * i + c] = part.positions[3 * v + c], colours[3 * i + c] = colour[c];
        });
        const edges = new THREE.BufferGeometry();
        edges.setAttribute('position', new THREE.BufferAttribute(ends, 3));
        edges.setAttribute('color', new THREE.BufferAttribute(colours, 3));
        this.lines.add(new THREE.LineSegments(edges, new THREE.LineBasicMaterial({vertexColors: true, toneMapped: false})));
        return {part, mesh, light};
    }

    /** The range of what is shown, a hundredth left out at either end, emitters too. */
    range(radiosity: boolean): [number, number] {
        const values: number[] = [];
        for (const {part, light} of this.loaded) {
            const E = light.array as Float32Array, every = Math.max(1, Math.floor(part.materials.length / 50000));
            for (let v = 0; v < part.materials.length; v += every) {
                const m = this.facts.materials[part.materials[v]];
                if (Math.max(...m.exitance) > 0) continue;
                let sum = 0;
                for (let c = 0; c < 3; ++c) sum += (radiosity ? m.reflectance[c] : 1) * E[3 * v + c] / 3;
                values.push(sum);
            }
        }
        values.sort((a, b) => a - b);
        if (values.length === 0) return [0, 1];
        const cut = Math.floor(values.length / 100);
        return [values[cut], values[values.length - 1 - cut]];
    }
}
