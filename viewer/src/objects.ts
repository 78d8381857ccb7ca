// The list of objects: groups of faces by name, which can be hidden or shown alone. Objects of one name are one entry.
import type {Facts} from './data';
import {by_id, make} from './page';

export class Objects {
    private hidden = new Set<number>();
    private of_name = new Map<string, number[]>();

    constructor(private facts: Facts, private changed: (hidden: number[]) => void) {
        [...facts.groups, ''].forEach((name, g) => {
            const of = this.of_name.get(name);
            if (of) of.push(g); else this.of_name.set(name, [g]);
        });
    }

    /** As before, after a new mesh of the same scene. */
    restore(old: Objects): void {
        if (old.facts.groups.join('\n') !== this.facts.groups.join('\n') || old.hidden.size === 0) return;
        this.hidden = new Set(old.hidden);
        this.tell();
    }

    get hidden_groups(): number[] { return [...this.hidden].sort((a, b) => a - b); }
    set hidden_groups(groups: number[]) { this.hidden = new Set(groups); this.tell(); }

    private alike(group: number): number[] { return this.of_name.get(this.facts.groups[group] ?? '') ?? [group]; }

    hide(group: number): void {
        for (const g of this.alike(group)) this.hidden.add(g);
        this.tell();
    }

    isolate(group: number): void {
        const kept = this.alike(group);
        this.hidden = new Set([...this.facts.groups.keys(), this.facts.groups.length].filter(g => !kept.includes(g)));
        this.tell();
    }

    show_all(): void {
        this.hidden.clear();
        this.tell();
    }

    private tell(): void {
        this.changed(this.hidden_groups);
        this.show();
    }

    /** The entries in the panel, in the order of their names. */
    show(): void {
        const names = [...this.of_name.keys()].filter(name => name !== '' || this.of_name.size === 1).sort((a, b) => a.localeCompare(b, undefined, {numeric: true}));
        by_id('objects_all').hidden = this.hidden.size === 0;
        by_id('objects_list').replaceChildren(...names.map((name, i) => {
            const groups = this.of_name.get(name)!, row = make('div', '', {class: 'object'}), label = make('label');
            const box = make('input', '', {type: 'checkbox', id: `object_${i}`}), only = make('button', 'only', {'aria-label': `Show only ${name || 'faces without a name'}`});
            box.checked = !groups.some(g => this.hidden.has(g));
            box.addEventListener('change', () => {
                for (const g of groups) box.checked ? this.hidden.delete(g) : this.hidden.add(g);
                this.changed(this.hidden_groups);
                by_id('objects_all').hidden = this.hidden.size === 0;
            });
            only.addEventListener('click', () => { this.isolate(groups[0]); document.getElementById(`object_${i}`)?.focus(); });
            label.append(box, ' ', name || 'all faces');
            row.append(label, only);
            return row;
        }));
    }
}
