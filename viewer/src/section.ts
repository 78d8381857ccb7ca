// The plane that cuts the room open.
import type {Facts} from './data';
import {box, by_id, choice} from './page';
import type {Shading} from './shading';

/** Shows the section that the panel describes. */
export function cut(facts: Facts, shading: Shading): void {
    const axis = choice('cut_axis'), c = axis ? 'xyz'.indexOf(axis) : -1, sign = box('cut_flip').checked ? -1 : 1;
    by_id('tool_section').setAttribute('aria-pressed', String(c >= 0));
    const [low, high] = c < 0 ? [0, 1] : [facts.box[0][c], facts.box[1][c]], at = low + (high - low) * Number(box('cut_at').value) / 1000;
    by_id('cut_text').textContent = c < 0 ? '' : `${at.toFixed(2)} m`;
    const normal = [0, 0, 0];
    if (c >= 0) normal[c] = sign;
    shading.cut(c < 0 ? null : [...normal, sign * at]);
}

/** Switches the section on, level, or off. `cut` shows it. */
export function toggle_section(): void {
    const select = by_id<HTMLSelectElement>('cut_axis');
    select.value = select.value ? '' : 'z';
    if (select.value) by_id<HTMLDetailsElement>('section').open = true;
}
