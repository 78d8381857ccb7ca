// Called by scripts/check_in_browser; see there.
const fs = require('fs'), path = require('path');
const {execFileSync} = require('child_process');
const {compare_pictures, launch, serve} = require('./browser.cjs');

const folder = process.env.exec_folder, cache = process.env.CACHE;
const size = [640, 400];

const page_text = `<!doctype html><meta charset="utf-8"><canvas id="c"></canvas>
<script type="importmap">{"imports": {"three": "/node_modules/three/build/three.module.js",
"three/addons/": "/node_modules/three/examples/jsm/"}}</script>
<script type="module">
import * as THREE from 'three';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {EXRLoader} from 'three/addons/loaders/EXRLoader.js';
const renderer = new THREE.WebGLRenderer({canvas: document.getElementById('c'), antialias: true, preserveDrawingBuffer: true});
renderer.setSize(${size[0]}, ${size[1]});
// Renders a model with unmodified three.js, from a camera of 'exitance render' (Z up, horizontal angle).
window.show = async (url, eye, target, fov, exr, exposure) => {
    const model = await new GLTFLoader().loadAsync(url);
    if (exr) {  // as documented in docs/light_maps.md
        const map = await new EXRLoader().loadAsync(exr);
        map.flipY = true; map.channel = 1;
        model.scene.traverse(mesh => {
            if (!mesh.isMesh) return;
            mesh.material.lightMap = map;
            mesh.material.lightMapIntensity = Math.PI * exposure;
        });
    }
    const scene = new THREE.Scene();
    scene.background = new THREE.Color(0);
    scene.add(model.scene);
    const aspect = ${size[0]} / ${size[1]}, across = Math.tan(fov * Math.PI / 360);
    const camera = new THREE.PerspectiveCamera(2 * Math.atan(across / aspect) * 180 / Math.PI, aspect, 0.01, 1000);
    const y_up = p => new THREE.Vector3(p[0], p[2], -p[1]);
    camera.position.copy(y_up(eye));
    camera.lookAt(y_up(target));
    renderer.render(scene, camera);
    return document.getElementById('c').toDataURL();
};
${compare_pictures}
window.ready = true;
</script>`;

function render(kind, camera, exposure) {
    const picture = path.join(folder, `${kind}.png`);
    const curve = kind === 'unlit' ? 'filmic' : 'linear';
    const words = ['render', process.env.SOLUTION, '-o', picture, '--size', size.join('x'), '--exposure', exposure + 'x',
        '--tone-map', curve];
    const out = execFileSync('sh', ['-c', '"$0" "$@" 2>&1', process.env.EXITANCE, ...words, ...(camera ? ['--camera', camera] : [])]);
    return [`/${kind}.png`, (/--camera '(.*)'/.exec(out) || [])[1]];
}

async function check_models(page, origin) {
    fs.writeFileSync(path.join(folder, 'three.html'), page_text);
    await page.goto(`${origin}/three.html`);
    await page.waitForFunction('window.ready');
    let failed = 0, camera = process.env.CAMERA;
    for (const kind of ['emissive', 'unlit', 'moz']) {
        const manifest = JSON.parse(fs.readFileSync(path.join(folder, kind, 'lightmaps.json')));
        const [reference, chosen] = render(kind, camera, manifest.exposure);
        camera = camera || chosen;
        const [eye, target, fov] = camera.split(' ').map(words => words.split(',').map(Number));
        const numbers = kind === 'moz' ? [`/${kind}/lightmap_0.exr`, manifest.exposure] : [];
        const shown = await page.evaluate(a => window.show(...a), [`/${kind}/scene.glb`, eye, target, fov[0], ...numbers]);
        if (process.env.KEEP) fs.writeFileSync(`${process.env.KEEP}/${kind}_three.png`, Buffer.from(shown.split(',')[1], 'base64'));
        if (process.env.KEEP) fs.copyFileSync(path.join(folder, `${kind}.png`), `${process.env.KEEP}/${kind}_render.png`);
        const [mean, far] = await page.evaluate(a => window.compare(...a), [shown, reference]);
        console.log(`${kind}: three.js differs from render by ${(100 * mean).toFixed(2)}% of white on average, ` +
            `${(100 * far).toFixed(2)}% of the pixels by more than a tenth`);
        failed += mean > 0.02;
    }
    return failed;
}

async function check_report(page) {
    const file = path.join(folder, 'report.html');
    if (!fs.existsSync(file)) return 0;
    const calls = [];
    page.on('request', request => { if (!/^(file|data|blob):/.test(request.url())) calls.push(request.url()); });
    await page.goto('file://' + file);
    const found = await page.evaluate(() => ({
        pictures: [...document.images].length,
        broken: [...document.images].filter(i => !i.complete || i.naturalWidth === 0).length,
        rows: document.querySelectorAll('tr').length,
    }));
    const pages = (await page.pdf({format: 'A4'})).toString('latin1').split('/Type /Page\n').length - 1;
    console.log(`report: ${found.pictures} pictures, ${found.broken} broken, ${found.rows} table rows, ${calls.length} calls, ` +
        `${pages} printed pages, ${(fs.statSync(file).size / 1e6).toFixed(2)} MB`);
    return found.pictures === 0 || found.broken > 0 || found.rows === 0 || calls.length > 0 || pages === 0 ? 1 : 0;
}

(async () => {
    const server = await serve(folder, cache);
    const browser = await launch();
    const page = await browser.newPage();
    page.on('pageerror', error => console.log('page: ' + error));
    const failed = await check_models(page, `http://127.0.0.1:${server.address().port}`) + await check_report(page);
    await browser.close();
    server.close();
    process.exit(failed > 0 ? 1 : 0);
})();
