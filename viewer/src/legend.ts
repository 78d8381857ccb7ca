// The legend of the picture.
import {css, short} from './colours';
import type {Compare} from './compare';
import type {Facts} from './data';
import {order_colours} from './elements';
import {box, by_id, make} from './page';
import type {Panes} from './panes';
import {class_colours, type Shading, type Shown} from './shading';

/** What the picture shows. */
export interface Picture {
    facts: Facts; shading: Shading; panes: Panes; compare: Compare | null;
    shown: Shown; isolux: boolean;
    threshold: number;  // negative: none
}

/** The name of a quantity, with its unit. */
export function title_of(facts: Facts, radiosity: boolean): string {
    const symbol = radiosity ? facts.units.radiosity : facts.units.irradiance;
    const lux = facts.units.irradiance === 'lx';
    return `${radiosity ? (lux ? 'luminous exitance' : 'radiosity') : lux ? 'illuminance' : 'irradiance'}, ${symbol}`;
}

function legend_row(colour: string, words: string, line = false): HTMLElement {
    const row = document.createElement('div'), mark = document.createElement('i');
    if (line) mark.className = 'line', mark.style.borderColor = colour;
    else mark.style.background = colour;
    row.append(mark, words);
    return row;
}

export function show_legend(now: Picture): void {
    const {facts, shading, panes, compare, shown, isolux} = now, legend = by_id('legend'), rows: HTMLElement[] = [];
    const values = shown === 'radiosity' || shown === 'irradiance';
    if (panes.arrangement === 'difference') {
        const quantity = title_of(facts, shown === 'radiosity');
        rows.push(make('strong', `difference of ${quantity}`), make('div', panes.words('difference')),
            ...compare!.legend().map(({colour, words}) => legend_row(css(colour), words)), legend_row('#737373', 'another surface'));
        legend.hidden = false;
        legend.replaceChildren(...rows);
        return;
    }
    if (values || isolux) rows.push(make('strong', title_of(facts, shown === 'radiosity')));
    for (const {colour, from, to} of values || isolux ? shading.legend() : [])
        rows.push(values ? legend_row(colour, `${short(from)} – ${short(to)}`) : legend_row(colour, short(from), true));
    if (now.threshold >= 0 && values) rows.push(legend_row('#ff3399', `threshold ${short(now.threshold)}`, true));
    if (shown === 'classes') for (const [name, colour] of class_colours) rows.push(legend_row(css(colour), name));
    if (box('mesh').checked && facts.discontinuities)
        for (const [name, colour] of Object.values(order_colours)) rows.push(legend_row(css(colour), name, true));
    legend.hidden = rows.length === 0;
    legend.replaceChildren(...rows);
}
