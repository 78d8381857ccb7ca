// Called by scripts/check_threejs_example; see there.
const fs = require('fs'), path = require('path');
const {execFileSync} = require('child_process');
const {compare_pictures, launch, serve} = require('./browser.cjs');

const folder = process.env.exec_folder, exitance = process.env.EXITANCE;
const size = [640, 400];

/** Renders a solution as the page shows it; returns its address and the camera. */
function render(solution, name, exposure, camera) {
    const words = ['render', solution, '-o', path.join(folder, name), '--size', size.join('x'), '--exposure', exposure + 'x',
        '--tone-map', 'linear', ...(camera ? ['--camera', camera] : [])];
    const out = execFileSync('sh', ['-c', '"$0" "$@" 2>&1', exitance, ...words]).toString();
    return ['/' + name, camera || /--camera '(.*)'/.exec(out)[1]];
}

(async () => {
    const manifest = JSON.parse(fs.readFileSync(path.join(folder, 'maps/lightmaps.json')));
    const [full, camera] = render(process.env.SOLUTION, 'full.png', manifest.exposure, process.env.CAMERA);
    const factors = manifest.groups.map((group, i) => [group.name, i % 2 ? 1.5 : 0.25]);
    execFileSync(exitance, ['mix', process.env.SOLUTION, ...factors.map(pair => pair.join('=')), '-o', path.join(folder, 'mixed.h5'), '-q']);
    const [dimmed] = render(path.join(folder, 'mixed.h5'), 'dimmed.png', manifest.exposure, camera);

    const server = await serve(folder, process.env.CACHE), browser = await launch();
    const page = await browser.newPage({viewport: {width: size[0], height: size[1]}});
    let failed = 0;
    page.on('pageerror', error => { console.log('page: ' + error); failed++; });
    const compare = async (what, reference) => {
        const shown = await page.evaluate(() => document.getElementById('view').toDataURL());
        if (process.env.KEEP) {
            fs.writeFileSync(path.join(process.env.KEEP, `threejs_${what}.png`), Buffer.from(shown.split(',')[1], 'base64'));
            await page.screenshot({path: path.join(process.env.KEEP, `threejs_${what}_page.png`)});
        }
        const [mean] = await page.evaluate(a => window.compare(...a), [shown, reference]);
        console.log(`${what}: three.js differs from render by ${(100 * mean).toFixed(2)}% of white on average`);
        failed += !(mean <= 0.02);
    };
    await page.goto(`http://127.0.0.1:${server.address().port}/index.html?camera=${encodeURIComponent(camera)}`);
    await page.waitForFunction(() => document.body.dataset.ready || document.getElementById('message').textContent);
    const message = await page.textContent('#message');
    if (message) { console.log('page: ' + message); failed++; }
    await page.evaluate(compare_pictures);
    await compare('full', full);
    for (const [name, factor] of factors)
        await page.locator(`input[name="${name}"]`).evaluate((input, value) => {
            input.value = value;
            input.dispatchEvent(new Event('input'));
        }, factor);
    await compare('dimmed', dimmed);
    await browser.close();
    server.close();
    process.exit(failed > 0 ? 1 : 0);
})();
