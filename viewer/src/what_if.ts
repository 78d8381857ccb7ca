// What if: a slider dims each light group, a colour repaints each material, and the light follows. Of requests that wait
// for one another the newest counts; elements stay, their light is filled in again.
import {load_changes, Newest, type Change, type Changes, type Facts, type Triple} from './data';
import {by_id} from './page';
import type {Panes} from './panes';
import type {Shading} from './shading';

const encoded = (x: number) => Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
const decoded = (x: number) => { x /= 255; return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4; };
const most_reflectance = 0.98;

export const colour_of = (r: Triple) => '#' + r.map(x => encoded(Math.min(Math.max(x, 0), 1)).toString(16).padStart(2, '0')).join('');
export const reflectance_of = (colour: string) =>
    [1, 3, 5].map(i => Number(Math.min(decoded(parseInt(colour.slice(i, i + 2), 16)), most_reflectance).toPrecision(4))) as Triple;

export class WhatIf {
    private newest = new Newest();
    private factors: number[] = [];
    private painted: (Triple | null)[] = [];
    private changes: Changes = {groups: [], materials: []};

    constructor(private facts: Facts, private panes: Panes, private shading: Shading, private changed: () => void) {}

    /** The panel, where the solution keeps what it needs. */
    async show(): Promise<void> {
        this.changes = await load_changes();
        // What is named alike is dimmed and painted alike, and is one entry.
        const unique = <T extends {name: string}>(all: T[]) => all.filter((x, i) => all.findIndex(y => y.name === x.name) === i);
        this.changes = {groups: unique(this.changes.groups), materials: unique(this.changes.materials)};
        const {groups, materials} = this.changes, place = by_id('change');
        by_id('change_section').hidden = groups.length + materials.length === 0;
        if (by_id('change_section').hidden) return;
        this.factors = groups.map(g => g.factor), this.painted = materials.map(() => null);
        const rows = [...groups.map((g, i) => this.slider(g.name, i)), ...materials.map((m, i) => this.colour(m.name, m.reflectance, i))];
        const reset = Object.assign(document.createElement('button'), {textContent: 'As solved'});
        reset.addEventListener('click', () => { void this.show().then(() => this.ask()); });
        const told = Object.assign(document.createElement('p'), {id: 'change_told'});
        told.setAttribute('role', 'status');
        place.replaceChildren(...rows, reset, told);
    }

    private row(name: string, id: string, ...controls: HTMLElement[]): HTMLElement {
        const row = document.createElement('div'), label = Object.assign(document.createElement('label'), {textContent: name, htmlFor: id});
        row.className = 'row';
        row.append(label, ...controls);
        return row;
    }

    private slider(name: string, i: number): HTMLElement {
        const id = `group_${i}`, factor = this.factors[i];
        const input = Object.assign(document.createElement('input'), {type: 'range', id, min: '0', max: '2', step: '0.01', value: String(factor)});
        const told = Object.assign(document.createElement('output'), {textContent: `${(100 * factor).toFixed(0)}%`});
        told.setAttribute('for', id);
        input.addEventListener('input', () => {
            this.factors[i] = Number(input.value);
            told.textContent = `${(100 * this.factors[i]).toFixed(0)}%`;
            this.ask();
        });
        return this.row(name || 'lamps without a group', id, input, told);
    }

    private colour(name: string, reflectance: Triple, i: number): HTMLElement {
        const id = `material_${i}`, mean = (r: Triple) => ((r[0] + r[1] + r[2]) / 3).toFixed(2);
        const input = Object.assign(document.createElement('input'), {type: 'color', id, value: colour_of(reflectance)});
        const told = Object.assign(document.createElement('output'), {textContent: mean(reflectance)});
        told.setAttribute('for', id);
        input.addEventListener('input', () => {
            this.painted[i] = reflectance_of(input.value);
            told.textContent = mean(this.painted[i]!);
            this.ask();
        });
        return this.row(name, id, input, told);
    }

    private change(): Change {
        const {groups, materials} = this.changes;
        const dim = groups.flatMap((g, i) => this.factors[i] === 1 ? [] : [`${g.name}:${this.factors[i]}`]);
        const paint = materials.flatMap((m, i) => this.painted[i] ? [`${m.name}:${this.painted[i]!.join('/')}`] : []);
        return {dim: dim.join(','), paint: paint.join(',')};
    }

    private ask(): void {
        const change = this.change(), begin = performance.now();
        const by_name = new Map(this.changes.groups.map((g, i) => [g.name, this.factors[i]]));
        const painted = new Map(this.changes.materials.map((m, i) => [m.name, this.painted[i] ?? m.reflectance]));
        this.newest.ask(async () => {
            try {
                await this.panes.refill(change);
            } catch (error) {
                by_id('change_told').textContent = String(error);
                return;
            }
            this.shading.dim(this.facts.groups.map(name => by_name.get(name) ?? 1));
            this.shading.paint(this.facts.materials.map(m => painted.get(m.name) ?? m.reflectance));
            this.changed();
            const took = performance.now() - begin;
            by_id('change_told').textContent = `${took.toFixed(0)} ms`;
            document.body.dataset.refilled = JSON.stringify({change, took});
        });
    }
}
