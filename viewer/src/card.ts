// The answer at a place of the picture: a value under the pointer, and a card with the exact light where one has clicked.
import * as THREE from 'three';
import {short} from './colours';
import type {Light, Triple} from './data';
import {by_id, make} from './page';

export interface CardActions { hide(group: number): void; isolate(group: number): void; copied(words: string): void }

const three = (v: Triple) => v.map(short).join('   ');

/** Fact and value, as rows of a list. */
function facts_list(rows: [string, string][]): HTMLElement {
    const list = make('dl');
    for (const [name, value] of rows) list.append(make('dt', name), make('dd', value));
    return list;
}

export class Card {
    private at: THREE.Vector3 | null = null;
    private card = by_id('card');
    private hover = by_id('hover');

    constructor(private actions: CardActions) {}

    get open(): boolean { return this.at !== null; }

    close(): void {
        this.at = null;
        this.card.hidden = true;
    }

    /** A value next to the pointer, in CSS pixels; null: none. */
    show_hover(x: number, y: number, words: string | null): void {
        this.hover.hidden = words === null;
        if (words === null) return;
        this.hover.textContent = words;
        this.place(this.hover, x + 14, y + 14);
    }

    /** A sentence where the card would be, such as what to do next. */
    tell(words: string): void {
        const text = make('p', words);
        text.style.whiteSpace = 'pre-line';
        this.card.replaceChildren(this.head(''), text);
        this.card.hidden = false;
        this.at = null;
        this.card.style.left = this.card.style.top = '';
    }

    private head(words: string): HTMLElement {
        const head = make('div'), close = make('button', '×', {'aria-label': 'Close', class: 'close'});
        head.className = 'head';
        close.addEventListener('click', () => { this.close(); by_id('picture').focus(); });
        head.append(make('strong', words), close);
        return head;
    }

    /** `number`: all bands as one number, in the unit. */
    show(light: Light, at: THREE.Vector3, number: (bands: Triple) => number, unit: string, group: number): void {
        const place = at.toArray().map(x => x.toFixed(3)).join(', ');
        const rows: [string, string][] = [['at', `${place} m`]];
        if (light.direct && light.indirect) rows.unshift(['from lamps and sky', `${short(number(light.direct))} ${unit}`],
            ['reflected', `${short(number(light.indirect))} ${unit}`]);
        if (light.group) rows.unshift(['object', light.group]);
        if (light.material) rows.splice(light.group ? 1 : 0, 0, ['material', light.material]);
        const buttons = make('div'), button = (name: string, act: () => void) => {
            const made = make('button', name);
            made.addEventListener('click', act);
            buttons.append(made);
        };
        buttons.className = 'buttons';
        if (light.group) {
            button('Hide object', () => this.actions.hide(group));
            button('Show only this', () => this.actions.isolate(group));
        }
        button('Copy', () => this.actions.copied(`${number(light.irradiance)} ${unit} at ${place} m`));
        const more = make('details'), deep: [string, string][] = [['E: red, green, blue', three(light.irradiance)]];
        if (light.direct && light.indirect) deep.push(['direct', three(light.direct)], ['reflected', three(light.indirect)]);
        if (light.radiosity) deep.push(['B: red, green, blue', three(light.radiosity)]);
        if (light.surface !== undefined)
            deep.push(['face', `${light.surface}${light.line ? ` (line ${light.line})` : ''}`], ['element', String(light.element ?? 'none')],
                ['links', `${light.links?.length ?? 0} links`]);
        more.append(make('summary', 'More'), facts_list(deep));
        this.card.replaceChildren(this.head(`${short(number(light.irradiance))} ${unit}`), facts_list(rows), buttons, more);
        this.card.hidden = false;
        this.at = at.clone();
    }

    /** Keeps the card at its point while the camera moves. */
    follow(camera: THREE.Camera, left: number, width: number, height: number): void {
        if (!this.at) return;
        const p = this.at.clone().project(camera), seen = p.z < 1;
        this.card.style.visibility = seen ? '' : 'hidden';
        if (seen) this.place(this.card, left + (p.x + 1) / 2 * width + 12, (1 - p.y) / 2 * height + 12);
    }

    /** Places a box in the picture, wholly inside of it. */
    private place(box: HTMLElement, x: number, y: number): void {
        const around = by_id('view');
        box.style.left = `${Math.max(4, Math.min(x, around.clientWidth - box.offsetWidth - 4))}px`;
        box.style.top = `${Math.max(4, Math.min(y, around.clientHeight - box.offsetHeight - 4))}px`;
    }
}
