// A solve that runs while the page shows its light.
import * as THREE from 'three';
import {post, type Triple} from './data';
import {draw_outlines} from './measure';
import {by_id} from './page';

/** Shows what the solve does, with its present shooter in `shooters`. Calls `load` whenever there is better light; `first` is
 *  true until there was some. */
export function follow_solve(shooters: THREE.Group, redraw: () => void, load: (first: boolean) => Promise<void>): void {
    by_id('stop').addEventListener('click', () => post('/data/stop').catch(error => { by_id('phase').textContent = String(error); }));
    by_id('save').addEventListener('click', () => post('/data/save').then(text => { by_id('phase').textContent = text; },
        error => { by_id('phase').textContent = String(error); }));
    const events = new EventSource('/data/events');
    by_id('running').hidden = false;
    events.addEventListener('progress', event => {
        const {phase, fraction, shooter} = JSON.parse((event as MessageEvent).data) as {phase: string; fraction: number; shooter: Triple[]};
        shooters.clear();
        if (shooter.length > 2) {
            draw_outlines(shooters, [shooter.map(p => new THREE.Vector3(...p))], 0xffd21a);
            document.body.dataset.shooters = String(Number(document.body.dataset.shooters ?? 0) + 1);
        }
        redraw();
        by_id<HTMLProgressElement>('progress').value = fraction;
        by_id('phase').textContent = phase;
    });
    let loading: Promise<void> = Promise.resolve(), shown = false;
    events.addEventListener('light', event => {
        const {count} = JSON.parse((event as MessageEvent).data);
        document.body.dataset.snapshots = String(count);
        loading = loading.then(() => load(!shown)).then(() => { shown = true; });
    });
    events.addEventListener('end', event => {
        by_id('phase').textContent = JSON.parse((event as MessageEvent).data).message;
        by_id<HTMLProgressElement>('progress').value = 1;
        by_id('stop').setAttribute('disabled', '');
        shooters.clear();
        redraw();
        document.body.dataset.ended = '1';
        events.close();
    });
}
