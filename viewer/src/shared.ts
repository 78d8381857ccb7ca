// A shared page: one file with the scene, the light of its elements and the state in which it was shared, as the button
// Share and `exitance view -o` write it (view_share.hpp). It needs no program, and so has no exact picture.
import type {Facts, Triple} from './data';
import type {SavedView} from './views';

/** Values of the page's controls by their id, and what the controls do not hold. */
export interface SharedState {
    camera: string; controls: Record<string, string | boolean>; range: [number, number] | null; exposure: number; hidden: number[];
    factors: number[]; reflectances: Triple[];
}

interface Shared { state: SharedState | null; views: SavedView[]; scene: Facts; parts: string[] }

const place = document.getElementById('shared');
export const shared = place && JSON.parse(place.textContent ?? '') as Shared;

export function shared_part(part: number): ArrayBuffer {
    const text = atob(shared!.parts[part]), bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    return bytes.buffer;
}

/** Ids of the controls whose values are shared. */
export const shared_controls = ['quantity', 'palette', 'scale_log', 'threshold', 'isolux', 'exposure', 'tone', 'cut_axis', 'cut_at', 'cut_flip'];

/** Text that is safe in a script element. */
const embedded = (value: unknown) => JSON.stringify(value).replaceAll('</', '<\\/');

/** The page of the program with a state and views. */
export function with_state(page: string, state: SharedState, views: SavedView[]): string {
    return page.replace('{"state":null,"views":[]', () => `{"state":${embedded(state)},"views":${embedded(views)}`);
}
