// Distances, and light along a line, in numbers.
import * as THREE from 'three';
import {short} from './colours';
import {by_id} from './page';

export interface Profile { length: number; values: number[]; delivered: number[]; raw: number[] }

const series = ['exact', 'delivered', 'raw'] as const;
const titles = {exact: 'exact', delivered: 'continuous', raw: "method's elements"};
const values_of = (profile: Profile, name: typeof series[number]) => name === 'exact' ? profile.values : profile[name];

export function distance_words(a: THREE.Vector3, b: THREE.Vector3): string {
    const way = b.clone().sub(a);
    return `${way.length().toFixed(3)} m  (${way.toArray().map(x => x.toFixed(3)).join(', ')} along x, y, z)`;
}

export function line_words(profile: Profile, a: THREE.Vector3, b: THREE.Vector3, unit: string): string {
    const mean = profile.values.reduce((sum, v) => sum + v, 0) / profile.values.length;
    return `${distance_words(a, b)}\n` +
        `light along it: ${short(Math.min(...profile.values))} to ${short(Math.max(...profile.values))} ${unit}, mean ${short(mean)} ${unit}`;
}

/** Three curves over the length, with round numbers at the axes. */
export function show_plot(profile: Profile, unit: string): void {
    const most = Math.max(1e-12, ...series.flatMap(name => values_of(profile, name)));
    const power = 10 ** Math.floor(Math.log10(most)), top = [1, 2, 5, 10].map(x => x * power).find(x => x >= most) ?? most;
    const [left, right, high, low] = [38, 268, 16, 128];
    const y = (v: number) => low - (low - high) * v / top, x = (t: number) => left + (right - left) * t;
    let drawing = '';
    for (const k of [0, 0.25, 0.5, 0.75, 1])
        drawing += `<line class="grid" x1="${left}" x2="${right}" y1="${y(k * top)}" y2="${y(k * top)}"/>` +
            `<text x="${left - 4}" y="${y(k * top) + 3}" text-anchor="end">${short(k * top)}</text>`;
    for (const t of [0, 0.5, 1])
        drawing += `<text x="${x(t)}" y="${low + 14}" text-anchor="${t === 1 ? 'end' : 'middle'}">${short(t * profile.length)}${t === 1 ? ' m' : ''}</text>`;
    drawing += `<text x="2" y="10">${unit}</text>`;
    for (const name of [...series].reverse()) {
        const values = values_of(profile, name);
        const path = values.map((v, i) => `${i ? 'L' : 'M'}${x(i / (values.length - 1)).toFixed(1)} ${y(v).toFixed(1)}`).join('');
        drawing += `<path class="${name}" d="${path}"/>`;
    }
    by_id('plot').innerHTML = drawing;
    by_id('plot').setAttribute('aria-label', `Light along ${short(profile.length)} m, ${unit}: from ` +
        `${short(Math.min(...profile.values))} to ${short(Math.max(...profile.values))}`);
    by_id('plot_key').innerHTML = series.map(name => `<svg width="24" height="8" aria-hidden="true"><line class="${name}" x1="0" x2="24" y1="4" y2="4" stroke-width="2"/></svg> ${titles[name]}`).join(' &nbsp; ');
    by_id('measured').hidden = false;
}

export function profile_csv(profile: Profile, a: THREE.Vector3, b: THREE.Vector3, unit: string): string {
    const rows = profile.values.map((exact, i) => {
        const t = i / (profile.values.length - 1), p = a.clone().lerp(b, t);
        return [t * profile.length, ...p.toArray(), exact, profile.delivered[i], profile.raw[i]].map(v => Number(v.toPrecision(7))).join(',');
    });
    return `s_m,x_m,y_m,z_m,exact,delivered,raw\n${rows.join('\n')}\n`.replace('exact,', `exact (${unit}),`);
}

/** Outlines in the scene: of an element, of what is linked to it, of a line that is measured. */
export function draw_outlines(into: THREE.Group, outlines: THREE.Vector3[][], colour: number, closed = true): void {
    for (const points of outlines) {
        const geometry = new THREE.BufferGeometry().setFromPoints(closed && points.length > 0 ? [...points, points[0]] : points);
        into.add(new THREE.Line(geometry, new THREE.LineBasicMaterial({color: colour, toneMapped: false})));
    }
}
