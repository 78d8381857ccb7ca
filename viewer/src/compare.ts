// Two lights of one scene, side by side and as a difference: of a second solution, or of lamps and materials that were kept.
import {difference_colours, short, signed} from './colours';
import {load_facts, unchanged, type Change, type Facts} from './data';
import {Elements} from './elements';
import {by_id, make} from './page';
import type {Comparison, Other, Panes} from './panes';
import type {Shading} from './shading';

const of_other: Change = {...unchanged, of: 'other'};
const name_of = (file: string) => file.split('/').pop() ?? file;

export class Compare {
    private others: Other[] = [];
    private kept = 0;
    private first = '';
    private select = by_id<HTMLSelectElement>('other');
    private way = by_id<HTMLSelectElement>('compare_as');
    private to = by_id<HTMLInputElement>('difference_to');
    private ranged = '';
    private most = 1;

    /** `changed`: the panes show something else. */
    constructor(private panes: Panes, private shading: Shading, private facts: Facts, private changed: () => void) {
        this.select.onchange = this.way.onchange = () => this.use();
        this.to.oninput = changed;
        by_id('keep').onclick = () => this.keep();
        by_id('difference_unit').textContent = facts.units.irradiance;
        this.list();
    }

    /** The panel; `keeps`: there are lamps or materials to change. `files`: of two solutions, of which the second is loaded. */
    async show(keeps: boolean, files: [string, string] | null): Promise<void> {
        by_id('keep_part').hidden = !keeps;
        by_id('compare_section').hidden = !keeps && files === null;
        if (files === null) return;
        const facts = await load_facts(of_other), shading = this.shading.make_twin(facts);
        const elements = new Elements(facts, shading, 'exported');
        await elements.load(of_other, () => {});
        const names = files.map(name_of);
        const [first, second] = names[0] === names[1] ? files : names;
        this.first = first;
        this.add({name: second, change: of_other, facts, elements, shading});
        document.body.dataset.other = '1';
    }

    keep(): void {
        if (by_id('keep_part').hidden || by_id('compare_section').hidden) return;
        this.add(this.panes.kept(`kept ${++this.kept}`));
        by_id<HTMLDetailsElement>('compare_section').open = true;
    }

    private add(other: Other): void {
        this.others.push(other);
        this.list();
        this.select.value = other.name;
        this.use();
    }

    private list(): void {
        const option = (words: string, value: string) => make('option', words, {value});
        this.select.replaceChildren(option('nothing', ''), ...this.others.map(o => option(o.name, o.name)));
        by_id('compare_with').hidden = this.others.length === 0;
        this.use();
    }

    private use(): void {
        const other = this.others.find(o => o.name === this.select.value) ?? null;
        this.panes.name = other && other.change.of ? this.first : 'now';
        this.panes.compare_with(other);
        by_id('compare_ways').hidden = other === null;
        by_id('difference_settings').hidden = other === null || this.way.value !== 'difference';
        this.ranged = '';
        this.changed();
    }

    /** How the panes are arranged; null where nothing is compared. */
    get arrangement(): Comparison | null { return this.panes.other ? this.way.value as Comparison : null; }

    /** Steps of the difference: of a chosen range, or of the light in the picture, found again when the light changes. */
    set_steps(most: () => number, radiosity: boolean): void {
        const words = JSON.stringify([radiosity, this.panes.change, this.panes.other?.name]);
        if (words !== this.ranged) this.ranged = words, this.most = most();
        this.shading.set_differences(Number(this.to.value) > 0 ? Number(this.to.value) : this.most);
        this.to.placeholder = short(this.most);
    }

    /** Bands from the most on down, in words. */
    legend(): {colour: [number, number, number]; words: string}[] {
        const {difference_steps: steps} = this.shading, {colours} = difference_colours(Number(this.to.value) > 0 ? Number(this.to.value) : this.most);
        return colours.map((colour, i) => ({colour, words: i === 0 ? `below ${signed(steps[0])}` : i === steps.length ? `above ${signed(steps[i - 1])}`
            : `${signed(steps[i - 1])} to ${signed(steps[i])}`})).reverse();
    }

    /** Both values and their difference, in words. */
    words([now, other]: [number, number]): string {
        return `${this.panes.name}: ${short(now)}, ${this.panes.other?.name}: ${short(other)}, difference ${signed(now - other)} ${this.facts.units.irradiance}`;
    }
}
