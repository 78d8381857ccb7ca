// Saved views: cameras with names, kept by the browser for this address, and as a file.
import {by_id, make} from './page';

export interface SavedView { name: string; camera: string }

export class Views {
    private all: SavedView[] = [];

    /** `given`: views that a shared page has; null: those that the browser keeps. */
    constructor(private file: string, private given: SavedView[] | null, private go: (camera: string) => void) {
        if (given) this.all = [...given];
        else try { this.all = JSON.parse(localStorage.getItem(this.key) ?? '[]') as SavedView[]; } catch { this.all = []; }
        this.show();
    }

    private get key(): string { return `exitance views of ${this.file}`; }

    get list(): SavedView[] { return this.all; }

    add(camera: string): void {
        this.all.push({name: `View ${this.all.length + 1}`, camera});
        this.keep();
    }

    /** As a file with a name and a camera a line, as `render --camera` takes them. */
    text(): string { return JSON.stringify(this.all, null, 1) + '\n'; }

    /** Takes the views of a file; false if it holds none. */
    read(text: string): boolean {
        try {
            const found = (JSON.parse(text) as SavedView[]).filter(v => typeof v.name === 'string' && typeof v.camera === 'string');
            if (found.length === 0) return false;
            this.all = found;
        } catch { return false; }
        this.keep();
        return true;
    }

    private keep(): void {
        if (!this.given) try { localStorage.setItem(this.key, JSON.stringify(this.all)); } catch { /* A browser may refuse to keep anything. */ }
        this.show();
    }

    private show(): void {
        by_id('views_save').hidden = this.all.length === 0;
        by_id('views_list').replaceChildren(...this.all.map((view, i) => {
            const row = make('div', '', {class: 'object'}), go = make('button', view.name, {class: 'wide'});
            const name = make('button', 'rename', {'aria-label': `Rename ${view.name}`}), drop = make('button', '×', {'aria-label': `Remove ${view.name}`});
            go.addEventListener('click', () => this.go(view.camera));
            name.addEventListener('click', () => { view.name = window.prompt('Name of the view', view.name)?.trim() || view.name; this.keep(); });
            drop.addEventListener('click', () => { this.all.splice(i, 1); this.keep(); });
            row.append(go, name, drop);
            return row;
        }));
    }
}
