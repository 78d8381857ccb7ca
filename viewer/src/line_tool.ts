// The tool that measures the light along a line between two points.
import * as THREE from 'three';
import type {Card} from './card';
import {load_line, type Change} from './data';
import {distance_words, draw_outlines, line_words, profile_csv, show_plot, type Profile} from './measure';
import {by_id} from './page';
import {save_file} from './save';
import {shared} from './shared';

export class LineTool {
    private ends: {point: THREE.Vector3; normal: THREE.Vector3}[] | null = null;  // null: a click gives the light at a point
    private csv = '';

    /** `drawn` gets the line. */
    constructor(private readonly card: Card, private readonly drawn: THREE.Group, private readonly redraw: () => void) {
        by_id('copy').addEventListener('click', () => navigator.clipboard.writeText(this.csv).then(() => card.tell('Copied.'),
            () => save_file('line.csv', 'text/csv', this.csv)));
    }

    get in_use(): boolean { return this.ends !== null; }

    /** Which answer a click gives: the light at a point, or what lies between two. */
    use(line: boolean): void {
        this.ends = line ? [] : null;
        by_id('tool_line').setAttribute('aria-pressed', String(line));
        by_id('tool_value').setAttribute('aria-pressed', String(!line));
        if (line) this.card.tell('Click on one end, or press Enter for the cross in the middle.'); else this.card.close();
    }

    /** Adds an end. The second one shows the light along the line, with changes of light if there are some. */
    async add_end(point: THREE.Vector3, normal: THREE.Vector3, unit: string, change: Change): Promise<void> {
        const ends = this.ends ?? [];
        ends.push({point: point.clone(), normal: normal.clone()});
        if (ends.length < 2) { this.card.tell('Now the other end.'); return; }
        const [a, b] = ends;
        this.ends = [];
        this.drawn.clear();
        draw_outlines(this.drawn, [[a.point, b.point]], 0xff7a1a, false);
        this.redraw();
        if (shared) { this.card.tell(distance_words(a.point, b.point)); return; }
        const profile = await load_line([...a.point.toArray(), ...b.point.toArray(), ...b.normal.toArray()], change) as Profile;
        this.card.tell(line_words(profile, a.point, b.point, unit));
        this.csv = profile_csv(profile, a.point, b.point, unit);
        by_id('measured_hint').hidden = true;
        by_id<HTMLDetailsElement>('measured_section').open = true;
        show_plot(profile, unit);
    }
}
