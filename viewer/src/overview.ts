// A view of the whole scene that shows its light: the brightest of some views from outside, or the room's own camera.
import * as THREE from 'three';
import type {Facts, Triple} from './data';
import type {Panes} from './panes';
import type {Viewpoint} from './camera';

type View = [Triple, Triple, number];

const test_width = 60, test_height = 40;  // pixels of a picture that is judged
const least_shown = 0.1;                  // of the pixels of a good view show the scene
const enough = 0.5;                       // of the pixels that show the scene, so many are lit in a good view
const is_lit = 55;                        // of 255: display values above are lit

/** Shares of a small picture: how much shows the scene, and how much of that is lit. */
function judge(renderer: THREE.WebGLRenderer, target: THREE.WebGLRenderTarget, panes: Panes, view: View): [number, number] {
    const [eye, to, fov] = view, camera = new THREE.PerspectiveCamera(50, test_width / test_height, 0.01, 1000), away = new THREE.Vector3(...eye).distanceTo(new THREE.Vector3(...to));
    camera.fov = 2 * Math.atan(Math.tan(fov * Math.PI / 360) * test_height / test_width) * 180 / Math.PI;
    camera.near = away / 1000, camera.far = away * 100;
    camera.up.set(0, 0, 1);
    camera.position.set(...eye);
    camera.lookAt(...to);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    renderer.setRenderTarget(target);
    renderer.setClearColor(0x000000, 0);
    panes.draw_preview(renderer, camera, false);
    const pixels = new Uint8Array(4 * test_width * test_height);
    renderer.readRenderTargetPixels(target, 0, 0, test_width, test_height, pixels);
    renderer.setRenderTarget(null);
    let shown = 0, lit = 0;
    for (let i = 0; i < pixels.length; i += 4) {
        if (pixels[i + 3] < 128) continue;
        ++shown;
        if (Math.max(pixels[i], pixels[i + 1], pixels[i + 2]) > is_lit) ++lit;
    }
    return [shown / (test_width * test_height), shown > 0 ? lit / shown : 0];
}

/** Views from eight sides at two heights, the present side first. */
export function overview(renderer: THREE.WebGLRenderer, panes: Panes, view: Viewpoint, facts: Facts): View {
    const target = new THREE.WebGLRenderTarget(test_width, test_height), offset = view.camera.position.clone().sub(view.target);
    const side = Math.atan2(offset.y, offset.x), viewport = renderer.getViewport(new THREE.Vector4());
    const at_rest: View = [facts.camera.eye, facts.camera.target, facts.camera.fov];
    renderer.setScissorTest(false);
    let best = at_rest, best_lit = -1;  // a black scene is shown, too
    search: for (const height of [0.55, 1.1])
        for (let i = 0; i < 8; ++i) {
            // 0, 1, -1, 2, -2, ... eighths of a turn from the present side.
            const turn = side + (i % 2 ? 1 : -1) * Math.ceil(i / 2) * Math.PI / 4;
            const away = new THREE.Vector3(Math.cos(turn) * Math.cos(height), Math.sin(turn) * Math.cos(height), Math.sin(height));
            const seen: View = [...view.whole_from(away), view.fov], [shown, lit] = judge(renderer, target, panes, seen);
            if (shown > least_shown && lit > best_lit) best = seen, best_lit = lit;
            if (best_lit >= enough) break search;
        }
    // A building seen from outside may be dark all around: then the view into the room is the one that shows light.
    const [shown, lit] = best_lit < enough ? judge(renderer, target, panes, at_rest) : [0, 0];
    if (shown > least_shown && lit > best_lit) best = at_rest;
    target.dispose();
    renderer.setViewport(viewport);
    return best;
}
