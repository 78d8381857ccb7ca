// The elements of the page.

export const by_id = <T extends Element = HTMLElement>(id: string) => document.getElementById(id) as unknown as T;

/** An input of the page, and the chosen value of a list. */
export const box = (id: string) => by_id<HTMLInputElement>(id);
export const choice = (id: string) => by_id<HTMLSelectElement>(id).value;

/** Makes an element with text and attributes. */
export function make<K extends keyof HTMLElementTagNameMap>(tag: K, text = '', attributes: Record<string, string> = {}): HTMLElementTagNameMap[K] {
    const made = document.createElement(tag);
    if (text) made.textContent = text;
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    return made;
}
