// Numbers at lines of equal light, where the lines cross a coarse grid of the picture. Made when the camera rests.
import type * as THREE from 'three';
import {short} from './colours';
import {by_id, make} from './page';

export interface Probe { value: number; object: number; normal: THREE.Vector3; point: THREE.Vector3 }

const grid = 90, apart = 70;  // CSS pixels: distance of the rays, least distance of two labels

/** True if two hits lie in one plane of one object, where light is continuous. */
const is_same = (a: Probe, b: Probe) => a.object === b.object && a.normal.dot(b.normal) > 0.999 &&
    Math.abs(b.point.clone().sub(a.point).dot(a.normal)) < 1e-4 * (1 + a.point.distanceTo(b.point));

export function clear_labels(): void { by_id('labels').replaceChildren(); }

export function show_labels(steps: number[], width: number, height: number, probe: (x: number, y: number) => Probe | null): void {
    const placed: [number, number, number][] = [];
    const add = (x: number, y: number, step: number) => {
        if (placed.some(([a, b, s]) => Math.hypot(a - x, b - y) < (s === step ? 2.2 : 1) * apart)) return;
        placed.push([x, y, step]);
    };
    /** The place between two rays at which the light is `step`, by bisection. */
    const cross = (x0: number, y0: number, x1: number, y1: number, low: Probe, step: number) => {
        for (let i = 0; i < 7; ++i) {
            const x = (x0 + x1) / 2, y = (y0 + y1) / 2, middle = probe(x, y);
            if (!middle || !is_same(low, middle)) return;
            if (middle.value < step === low.value < step) x0 = x, y0 = y; else x1 = x, y1 = y;
        }
        add(x0, y0, step);
    };
    const columns = Math.floor(width / grid), rows = Math.floor(height / grid), found: (Probe | null)[] = [];
    const place = (i: number, k: number): [number, number] => [(i + 0.5) * width / columns, (k + 0.5) * height / rows];
    for (let k = 0; k < rows; ++k) for (let i = 0; i < columns; ++i) found.push(probe(...place(i, k)));
    for (let k = 0; k < rows; ++k)
        for (let i = 0; i < columns; ++i)
            for (const [di, dk] of [[1, 0], [0, 1]]) {
                const a = found[k * columns + i], b = i + di < columns && k + dk < rows ? found[(k + dk) * columns + i + di] : null;
                if (!a || !b || !is_same(a, b)) continue;
                for (const step of steps)
                    if (step > 0 && a.value < step !== b.value < step) cross(...place(i, k), ...place(i + di, k + dk), a, step);
            }
    by_id('labels').replaceChildren(...placed.map(([x, y, step]) => {
        const label = make('span', short(step));
        label.style.left = `${x}px`, label.style.top = `${y}px`;
        return label;
    }));
}
