// Called by scripts/check_viewer; see there.
const fs = require('fs'), path = require('path');
const {execFileSync, spawn} = require('child_process');
const {chromium} = require('playwright-core');
const {EXITANCE: exitance, SOLUTION: solution, SCENE: scene, WORK: folder} = process.env;
const size = [940, 400];
let failed = 0;
const programs = [];
process.on('exit', () => programs.forEach(p => p.kill()));

function check(good, words) {
    console.log(`${good ? 'ok' : 'FAILED'}: ${words}`);
    if (!good) ++failed;
}

/** The program showing something, once it tells where. */
function start(...words) {
    const program = spawn(exitance, ['view', ...words, '-q'], {stdio: ['ignore', 'pipe', 'inherit'], cwd: folder});
    programs.push(program);
    return new Promise((done, fail) => {
        program.stdout.once('data', data => done({program, origin: String(data).trim()}));
        program.once('exit', code => fail(new Error(`view ended with ${code}`)));
    });
}

/** Mean difference as a share of white, right of the panel, where nothing is drawn over the picture. */
async function difference(page, a, b) {
    return page.evaluate(async ([a, b]) => {
        const pixels = async url => {
            const image = new Image();
            image.src = url;
            await image.decode();
            const canvas = new OffscreenCanvas(image.width, image.height), context = canvas.getContext('2d');
            context.drawImage(image, 0, 0);
            return context.getImageData(0, 0, image.width, image.height).data;
        };
        const [p, q] = [await pixels(a), await pixels(b)];
        let sum = 0;
        for (let i = 0; i < p.length; ++i) if (i % 4 < 3) sum += Math.abs(p[i] - q[i]) / 255;
        return p.length === q.length ? sum / (0.75 * p.length) : 1;
    }, [a, b]);
}

const png = file => 'data:image/png;base64,' + fs.readFileSync(file).toString('base64');

/** Raw, delivered and exact light: alone, split, side by side. */
async function compare(page, picture) {
    const keep = async name => {
        const shown = await page.evaluate(() => exitance.canvas());
        if (process.env.KEEP) fs.writeFileSync(path.join(process.env.KEEP, name + '.png'), Buffer.from(shown.split(',')[1], 'base64'));
        return shown;
    };
    await page.evaluate(() => document.querySelectorAll('details').forEach(d => { d.open = true; }));
    await page.waitForFunction(() => exitance.whole());
    const exact = await keep('exact'), apart = await difference(page, exact, png(picture));
    check(apart < 0.01, `the picture at rest differs from render by ${(100 * apart).toFixed(2)}% of white (1% allowed)`);
    const dots_at_rest = await dark_dots(page);
    await page.selectOption('#source', 'delivered');
    const delivered = await keep('delivered'), dots = await dark_dots(page);
    check(dots <= 1.5 * dots_at_rest + 50, `while moving ${dots} dark dots along edges, at rest ${dots_at_rest} (half as many more allowed)`);
    await page.selectOption('#source', 'raw');
    await page.waitForFunction(() => document.body.dataset.raw);
    const raw = await keep('raw'), rough = await difference(page, raw, delivered);
    check(rough > 0.003 && rough < 0.2, `raw elements differ from the delivered light by ${(100 * rough).toFixed(2)}% of white`);
    await page.selectOption('#arrangement', 'split');
    await page.waitForFunction(() => exitance.whole());
    await page.focus('.divider');
    for (let i = 0; i < 40; ++i) await page.keyboard.press('ArrowLeft');
    await page.focus('.divider >> nth=1');
    for (let i = 0; i < 80; ++i) await page.keyboard.press('ArrowLeft');
    check(await difference(page, await keep('split'), exact) < 0.002, 'dividers at the left leave the exact picture');
    for (let i = 0; i < 100; ++i) await page.keyboard.press('ArrowRight');
    check(await difference(page, await keep('split'), delivered) < 0.002, 'and at either side the delivered light');
    await page.selectOption('#arrangement', 'panes');
    await page.waitForFunction(() => exitance.whole() && document.getElementById('panes').textContent === "method's elementscontinuousexact");
    await keep('panes');
    check(true, 'three panes with their names');
    await page.selectOption('#arrangement', 'one');
    await page.selectOption('#source', 'best');
}

async function check_solution(page) {
    const {program, origin} = await start(solution);
    const begin = Date.now(), foreign = [];
    page.on('request', r => { if (!r.url().startsWith(origin) && !/^(data|blob):/.test(r.url())) foreign.push(r.url()); });
    await page.goto(origin);
    await page.waitForFunction('document.body.dataset.first');
    console.log(`first picture ${Date.now() - begin} ms after the page was asked for`);
    await page.waitForFunction('document.body.dataset.ready');
    const [words, exposure, drawn] = await page.evaluate(() => [exitance.words(), exitance.exposure(), exitance.size()]);
    const picture = path.join(folder, 'render.png');
    execFileSync(exitance, ['render', solution, '-o', picture, '--size', drawn.join('x'), '--camera', words,
        '--exposure', exposure + 'x', '--tone-map', 'filmic', '-q']);
    await page.evaluate(() => document.querySelectorAll('details').forEach(d => { d.open = true; }));
    await page.selectOption('#source', 'delivered');
    const shown = await page.evaluate(() => exitance.canvas());
    if (process.env.KEEP) fs.writeFileSync(path.join(process.env.KEEP, 'viewer.png'), Buffer.from(shown.split(',')[1], 'base64'));
    const apart = await difference(page, shown, png(picture));
    check(apart < 0.03, `while moving it differs from render by ${(100 * apart).toFixed(2)}% of white on average (3% allowed)`);
    await page.selectOption('#source', 'best');
    await check_answers(page, origin);
    await compare(page, picture);
    await page.selectOption('#quantity', 'irradiance');
    check(await page.isVisible('#legend') && /W\/m²|lx/.test(await page.textContent('#legend')), 'a legend with units');
    await check_colours(page);
    await page.focus('#picture');
    await page.keyboard.press('m');
    check(await page.isChecked('#mesh'), 'the keyboard shows the mesh');
    await page.keyboard.press('f');
    check(/^#camera=/.test(await page.evaluate('location.hash')), 'the camera stands in the address');
    await page.selectOption('#quantity', 'picture');
    await page.keyboard.press('m');
    await page.goto(origin);
    await page.waitForFunction('document.body.dataset.ready');
    await check_tools(page);
    await check_access(page);
    await page.goto('about:blank');  // the page would report that the server has ended
    check(foreign.length === 0, `${foreign.length} calls elsewhere`);
    program.kill();
}

/** Number of pixels that are much darker than both neighbours at a distance of two, as dots along edges are. */
async function dark_dots(page) {
    return page.evaluate(async () => {
        const image = new Image();
        image.src = exitance.canvas();
        await image.decode();
        const canvas = new OffscreenCanvas(image.width, image.height), context = canvas.getContext('2d');
        context.drawImage(image, 0, 0);
        const p = context.getImageData(0, 0, image.width, image.height).data, level = (x, y) => p[4 * (y * image.width + x) + 1];
        let dots = 0;
        for (let y = 2; y + 2 < image.height; ++y)
            for (let x = 2; x + 2 < image.width; ++x) {
                const across = level(x, y) < 0.7 * Math.min(level(x - 2, y), level(x + 2, y)), down = level(x, y) < 0.7 * Math.min(level(x, y - 2), level(x, y + 2));
                if (across || down) ++dots;
            }
        return dots;
    });
}

/** A value under the pointer, and a card with the exact one, which agrees with `probe`. */
async function check_answers(page) {
    const [x, y] = [size[0] * 0.4, size[1] * 0.7];
    await page.mouse.move(x, y);
    await page.waitForFunction(() => !document.getElementById('hover').hidden);
    const hover = await page.textContent('#hover');
    await page.mouse.click(x, y);
    await page.waitForFunction(() => /reflected/.test(document.getElementById('card').textContent), null, {timeout: 10000});
    const card = await page.textContent('#card'), exact = parseFloat(await page.textContent('#card strong'));
    check(/W\/m²|lx/.test(hover) && Math.abs(parseFloat(hover) - exact) < 0.3 * exact, `${hover} under the pointer, ${exact} on the card`);
    const box = await page.locator('#card').boundingBox();
    check(box.x >= 0 && box.y >= 0 && box.x + box.width <= size[0] && box.y + box.height <= size[1] && Math.abs(box.x - x) < 300,
        'the card is in the picture, near the point');
    const light = await page.evaluate(() => exitance.canvas());
    await page.click('#card >> text=Hide object');
    check(await difference(page, light, await page.evaluate(() => exitance.canvas())) > 0.003, 'an object is hidden from its card: ' + card.slice(0, 40));
    await page.click('#objects_all');
    await page.focus('#picture');
    await page.keyboard.press('Escape');
    check(await page.isHidden('#card'), 'Esc closes the card');
}

/** The range of the colours by its handles and numbers, the palette, and the threshold. */
async function check_colours(page) {
    const read = () => page.evaluate(() => [document.getElementById('legend').textContent, exitance.canvas()]);
    const [words, shown] = await read();
    check(!await page.isChecked('#scale_log'), 'colours are linear at first');
    await page.check('#scale_log');
    check(Number(await page.inputValue('#scale_lo_number')) > 0 && !/(^|[^.\d])0 –/.test((await read())[0]), 'a logarithmic scale has no 0');
    await page.uncheck('#scale_log');
    await page.focus('#scale_hi');
    for (let i = 0; i < 400; ++i) await page.keyboard.press('ArrowLeft');
    const [narrow, brighter] = await read();
    check(narrow !== words && await difference(page, shown, brighter) > 0.005, 'the upper handle changes legend and picture');
    await page.selectOption('#palette', 'inferno');
    check(await difference(page, brighter, (await read())[1]) > 0.01, 'so does the palette');
    await page.fill('#threshold', await page.inputValue('#scale_hi_number'));
    check(/threshold/.test((await read())[0]), 'a threshold is in the legend');
    await page.fill('#threshold', '');
    await page.selectOption('#palette', 'viridis');
    await page.click('#scale_auto');
    const again = (await read())[0];
    check(again === words, `and the automatic range comes back: ${again}${again === words ? '' : ', was ' + words}`);
}

/** Share of the pixels that show backs of faces, and of those that show neither fronts nor backs. */
async function dark_shares(page) {
    return page.evaluate(async () => {
        const image = new Image();
        image.src = exitance.canvas();
        await image.decode();
        const canvas = new OffscreenCanvas(image.width, image.height), context = canvas.getContext('2d');
        context.drawImage(image, 0, 0);
        const p = context.getImageData(0, 0, image.width, image.height).data, sky = getComputedStyle(document.documentElement).getPropertyValue('--sky').trim();
        const [r, g, b] = [1, 3, 5].map(i => parseInt(sky.slice(i, i + 2), 16));
        let empty = 0;
        for (let i = 0; i < p.length; i += 4)
            if (Math.abs(p[i] - r) + Math.abs(p[i + 1] - g) + Math.abs(p[i + 2] - b) <= 3) ++empty;
        return [exitance.back_share(), 4 * empty / p.length];
    });
}

/** Drags and walks in ten rooms never leave them; the overview shows light. */
async function check_rooms(page) {
    const rooms = [['office', 'nx=1', 'ny=1', 'nfurn=0'], ['office', 'nx=1', 'ny=1', 'nfurn=2', 'books=3'], ['office', 'nx=2', 'ny=1', 'nfurn=1'],
        ['office', 'nx=1', 'ny=2', 'nfurn=2'], ['cornell'], ['cove'], ['door'], ['gaps'], ['blocker'], ['complex', 'm=1']];
    let worst = 0, least_lit = 1, tried = 0;
    const unmeasured = [];
    for (const [number, words] of rooms.entries()) {
        const obj = path.join(folder, `room_${number}.obj`), h5 = path.join(folder, `room_${number}.h5`);
        try {
            execFileSync(exitance, ['generate', ...words, '-o', obj, '-q'], {stdio: 'pipe'});
            execFileSync(exitance, ['solve', obj, '-o', h5, '--error', '0.5', '-q'], {stdio: 'pipe'});
        } catch (error) { check(false, `${words}: ${String(error.stderr ?? error).slice(0, 200)}`); continue; }
        const {program, origin} = await start(h5);
        await page.goto(origin);
        await page.waitForFunction('document.body.dataset.ready');
        const inside = await page.evaluate(() => exitance.inside());
        // The first view looks along the edge between two walls: a ray that meets it exactly must not pass between them.
        await page.focus('#picture');
        await page.keyboard.press('l');
        await page.keyboard.press('Enter');
        const answer = await page.textContent('#card');
        if (inside && /There is nothing/.test(answer)) unmeasured.push(words.join(' '));
        await page.keyboard.press('Escape');
        for (const [dx, dy] of [[160, 0], [-320, 40], [200, -80], [-90, 120], [250, 10]]) {
            await page.mouse.move(320, 220);
            await page.mouse.down();
            await page.mouse.move(320 + dx, 220 + dy, {steps: 4});
            await page.mouse.up();
            await page.mouse.wheel(0, -600);
            const [backs, empty] = await dark_shares(page);
            worst = Math.max(worst, backs, inside ? empty : 0), ++tried;
            if (backs > 0.05 || (inside && empty > 0.05)) {
                console.log(`  ${words.join(' ')}: ${(100 * backs).toFixed(1)}% backs, ${(100 * empty).toFixed(1)}% empty at ${await page.evaluate(() => exitance.words())}`);
                if (process.env.KEEP) await page.screenshot({path: path.join(process.env.KEEP, `lost_${number}.png`)});
            }
        }
        await page.click('#fit');
        const [backs, empty] = await dark_shares(page);
        least_lit = Math.min(least_lit, 1 - empty - backs);
        await page.goto('about:blank');
        program.kill();
    }
    check(unmeasured.length === 0, `rooms whose middle cannot be measured in the first view: ${unmeasured.join(', ') || 'none'}`);
    check(tried >= 45 && worst < 0.05, `in ${tried} drags and walks at most ${(100 * worst).toFixed(2)}% of the pixels showed backs of faces or nothing (5% allowed)`);
    check(least_lit > 0.1, `overviews show the scene in ${(100 * least_lit).toFixed(0)}% of the pixels at least`);
}

/** A line with its plot and its numbers; lines of equal light; a path that `render` takes. */
async function check_tools(page) {
    await page.evaluate(() => document.querySelectorAll('details').forEach(d => { d.open = true; }));
    await page.focus('#picture');
    const plain = await page.evaluate(() => exitance.canvas());
    await page.keyboard.press('i');
    const lines = await difference(page, plain, await page.evaluate(() => exitance.canvas()));
    check(lines > 0.0005 && await page.isVisible('#legend') && /\d/.test(await page.textContent('#legend')),
        `lines of equal light change ${(100 * lines).toFixed(2)}% of white, and have numbers`);
    await page.keyboard.press('i');
    await page.keyboard.press('l');
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => /other end/.test(document.getElementById('card').textContent));
    for (let i = 0; i < 3; ++i) await page.keyboard.press('ArrowUp');
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => !document.getElementById('measured').hidden);
    check(/\d m/.test(await page.textContent('#card')), 'the card has the distance: ' + (await page.textContent('#card')).slice(1, 60).replaceAll('\n', '; '));
    await page.keyboard.press('Escape');
    check(await page.locator('#plot path').count() === 3, 'a line is plotted for raw, delivered and exact light, by keyboard alone');
    await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
    await page.click('#copy');
    await page.waitForFunction(() => /Copied/.test(document.getElementById('card').textContent));
    const rows = (await page.evaluate(() => navigator.clipboard.readText())).trim().split('\n');
    check(rows.length === 130 && rows[0].startsWith('s_m,x_m,y_m,z_m,exact'), `its ${rows.length - 1} points are copied as CSV`);
    await page.click('#record');
    await page.focus('#picture');
    for (let i = 0; i < 8; ++i) { await page.keyboard.press('ArrowLeft'); await page.waitForTimeout(60); }
    await page.click('#record');
    await page.click('#replay');
    const [download] = await Promise.all([page.waitForEvent('download'), page.click('#save_path')]);
    const walk = path.join(folder, 'path.csv');
    await download.saveAs(walk);
    const stations = fs.readFileSync(walk, 'utf8').trim().split('\n').length - 1;
    execFileSync(exitance, ['render', solution, '-o', path.join(folder, 'walk.png'), '--path', walk, '--size', '32x20', '--samples', '1', '-q']);
    check(stations >= 2 && fs.readdirSync(folder).filter(f => /^walk\.\d+\.png$/.test(f)).length === stations,
        `a path of ${stations} cameras is recorded, saved, and rendered`);
}

/** Everything by keyboard, with names; text that stands out by 4.5 to 1 in light and dark. */
async function check_access(page) {
    const unnamed = await page.evaluate(() => [...document.querySelectorAll('button, input, select, canvas, svg:not([aria-hidden]), [role=separator]')]
        .filter(e => !(e.labels?.length || e.getAttribute('aria-label') || e.textContent.trim())).map(e => e.id || e.tagName));
    check(unnamed.length === 0, `controls without a name: ${unnamed.join() || 'none'}`);
    await page.selectOption('#arrangement', 'split');
    await page.evaluate(() => { document.activeElement.blur(); });
    await page.evaluate(() => document.querySelectorAll('details').forEach(d => { d.open = true; }));
    const wanted = await page.evaluate(() => [...document.querySelectorAll('button, input, select, summary, canvas, [role=separator]')]
        .filter(e => e.checkVisibility() && !e.disabled && e.tabIndex >= 0).length);
    const reached = new Set();
    for (let i = 0; i < wanted + 3; ++i) {
        await page.keyboard.press('Tab');
        reached.add(await page.evaluate(() => {
            const e = document.activeElement;
            return e === document.body ? '' : e.id || e.getAttribute('aria-label') || e.tagName + e.textContent;
        }));
    }
    reached.delete('');
    check(reached.size === wanted, `Tab reaches ${reached.size} of ${wanted} controls`);
    await page.selectOption('#arrangement', 'one');
    await page.evaluate(() => { document.querySelectorAll('details').forEach(d => { d.open = false; }); document.activeElement.blur(); });
    const stops = await page.evaluate(() => [...document.querySelectorAll('button, input, select, summary, canvas, [role=separator]')]
        .filter(e => e.checkVisibility() && !e.disabled && e.tabIndex >= 0).length);
    check(stops <= 14, `with folded sections there are ${stops} stops of the Tab key (14 allowed)`);
    for (const colorScheme of ['light', 'dark']) {
        await page.emulateMedia({colorScheme});
        const worst = await page.evaluate(() => {
            const rgb = c => { const m = c.match(/[\d.]+/g).map(Number); return m.length > 3 && m[3] === 0 ? null : m.slice(0, 3); };
            const level = c => c.map(x => x / 255).map(x => x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4)
                .reduce((sum, x, i) => sum + [0.2126, 0.7152, 0.0722][i] * x, 0);
            let low = [99, ''];
            for (const e of document.querySelectorAll('aside *, #bar *, #card *, #legend *, #panes *')) {
                if (!e.checkVisibility() || ![...e.childNodes].some(n => n.nodeType === 3 && n.data.trim()) || e.closest(':disabled')) continue;
                let back = null;
                for (let p = e; p && !back; p = p.parentElement) back = rgb(getComputedStyle(p).backgroundColor);
                const text = e.namespaceURI.endsWith('svg') ? getComputedStyle(e).fill : getComputedStyle(e).color;
                const [a, b] = [level(rgb(text)), level(back ?? [255, 255, 255])].sort((x, y) => y - x);
                const contrast = (a + 0.05) / (b + 0.05);
                if (contrast < low[0]) low = [contrast, e.id || e.tagName];
            }
            return low;
        });
        check(worst[0] >= 4.5, `contrast of text in ${colorScheme}: ${worst[0].toFixed(1)} at least (${worst[1]})`);
    }
}

/** A solution with a discontinuity mesh and one with links, of the scene. */
async function check_layers(page) {
    const meshed = path.join(folder, 'meshed.h5'), linked = path.join(folder, 'linked.h5');
    execFileSync(exitance, ['solve', scene, '-o', meshed, '--method', 'discontinuity', '--error', '0.1', '-q']);
    execFileSync(exitance, ['solve', scene, '-o', linked, '--keep-links', '--method', 'hierarchical', '--error', '0.1', '-q']);
    let {program, origin} = await start(meshed);
    await page.goto(origin);
    await page.waitForFunction('document.body.dataset.ready');
    await page.evaluate(() => document.querySelectorAll('details').forEach(d => { d.open = true; }));
    await page.selectOption('#quantity', 'classes');
    await page.selectOption('#source', 'delivered');
    const [words, drawn] = await page.evaluate(() => [exitance.words(), exitance.size()]);
    const picture = path.join(folder, 'classes.png');
    execFileSync(exitance, ['render', meshed, '-o', picture, '--size', drawn.join('x'), '--camera', words, '--shadow-classes', '-q']);
    const shown = await page.evaluate(() => exitance.canvas());
    if (process.env.KEEP) fs.writeFileSync(path.join(process.env.KEEP, 'classes.png'), Buffer.from(shown.split(',')[1], 'base64'));
    // The remaining differences are the legend that `render` draws, and the sky.
    const apart = await difference(page, shown, png(picture));
    check(apart < 0.08, `shadow classes differ from render by ${(100 * apart).toFixed(2)}% of white (8% allowed: its key, the sky)`);
    await page.check('#mesh');
    check(/umbra/.test(await page.textContent('#legend')) && /D1 slope/.test(await page.textContent('#legend')), 'classes and orders are in the legend');
    program.kill();
    ({program, origin} = await start(linked));
    await page.goto(origin);
    await page.waitForFunction('document.body.dataset.ready');
    await page.focus('#picture');
    const before = await page.evaluate(() => exitance.canvas());
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => / links/.test(document.getElementById('card').textContent));
    const links = Number((await page.textContent('#card')).match(/(\d+) links/)[1]);
    check(links > 0 && await difference(page, before, await page.evaluate(() => exitance.canvas())) > 0.001, `${links} linked elements are outlined`);
    program.kill();
}

/** Sliders against a server that answers half the light for a dimmed group: what is asked for and how often. */
async function check_sliders(page) {
    const {program, origin} = await start(solution), asked = [];
    const facts = await (await fetch(origin + 'data/scene')).json();
    const lamp = facts.groups[0] ?? 'none', wall = facts.materials[0].name;
    await page.route('**/groups', route => route.fulfill({json: {groups: [{name: lamp, factor: 1}], materials: [facts.materials[0]]}}));
    await page.route(/data\/part.*(dim|paint)=/, async route => {
        const url = new URL(route.request().url());
        asked.push([url.searchParams.get('dim'), url.searchParams.get('paint')]);
        for (const word of ['dim', 'paint', 'only']) url.searchParams.delete(word);
        const body = Buffer.from(await (await fetch(url)).arrayBuffer()), v = body.readUInt32LE(4);
        for (let i = 0; i < 3 * v; ++i) body.writeFloatLE(0.5 * body.readFloatLE(12 + 12 * v + 4 * i), 12 + 12 * v + 4 * i);
        await route.fulfill({body, contentType: 'application/octet-stream'});
    });
    await page.goto(origin);
    await page.waitForFunction('document.body.dataset.whatif');
    await page.evaluate(() => document.querySelectorAll('details').forEach(d => { d.open = true; }));
    await page.selectOption('#source', 'delivered');
    const before = await page.evaluate(() => exitance.canvas());
    await page.focus('#group_0');
    for (let i = 0; i < 50; ++i) await page.keyboard.press('ArrowLeft');
    await page.waitForFunction(lamp => JSON.parse(document.body.dataset.refilled ?? '{}').change?.dim === lamp + ':0.5', lamp);
    check(asked.length <= 51 && asked.at(-1)[0] === lamp + ':0.5', `a slider asked ${asked.length} times in 50 steps, last for ${asked.at(-1)[0]}`);
    const after = await difference(page, before, await page.evaluate(() => exitance.canvas()));
    check(after > 0.05, `the light follows: ${(100 * after).toFixed(1)}% of white`);
    await page.fill('#material_0', '#808080');
    await page.waitForFunction(() => JSON.parse(document.body.dataset.refilled).change.paint);
    check(asked.at(-1)[1] === wall + ':0.2159/0.2159/0.2159', `a colour paints ${asked.at(-1)[1]}`);
    await page.click('#change button');
    await page.waitForFunction(() => { const {change} = JSON.parse(document.body.dataset.refilled); return !change.dim && !change.paint; });
    const back = await difference(page, before, await page.evaluate(() => exitance.canvas()));
    check(back < 1e-6, 'and goes back to what was solved');
    await page.unrouteAll();
    await page.goto('about:blank');
    program.kill();
}

/** A kept setting, and a second solution: with a divider, side by side, and as a difference with its range and values. */
async function check_compare(page, first, second) {
    const {program, origin} = await start(first, second);
    const keep = async name => { if (process.env.KEEP) await page.screenshot({path: path.join(process.env.KEEP, name + '.png')}); };
    await page.goto(origin);
    await page.waitForFunction('document.body.dataset.other');
    await page.evaluate(() => { document.getElementById('compare_section').open = true; });
    const names = await page.textContent('#panes');
    check(names === path.basename(first) + path.basename(second), `two solutions beside a divider: ${names}`);
    await keep('compare_files');
    await page.evaluate(() => { document.getElementById('change_section').open = true; });
    await page.click('#keep');
    const kept = await page.evaluate(() => exitance.canvas());
    await page.focus('#group_0');
    for (let i = 0; i < 50; ++i) await page.keyboard.press('ArrowLeft');
    await page.waitForFunction(() => /:0.5/.test(JSON.parse(document.body.dataset.refilled ?? '{}').change?.dim));
    await keep('compare_kept');
    await page.focus('#half');
    for (let i = 0; i < 12; ++i) await page.keyboard.press('Shift+ArrowLeft');
    check(await difference(page, kept, await page.evaluate(() => exitance.canvas())) < 0.002, 'the kept setting stays as it was');
    await page.selectOption('#compare_as', 'beside');
    check(await page.textContent('#panes') === 'nowkept 1', 'two pictures have their names');
    await keep('compare_beside');
    await page.selectOption('#compare_as', 'difference');
    await page.waitForFunction(() => /minus/.test(document.getElementById('legend').textContent));
    const legend = await page.textContent('#legend');
    check(/difference of .*, (lx|W\/m²)now minus kept 1.*above [−+].*below −/.test(legend), `a difference has a range: ${legend}`);
    await page.mouse.move(size[0] * 0.4, size[1] * 0.7);
    await page.waitForFunction(() => /difference/.test(document.getElementById('hover').textContent));
    const hover = await page.textContent('#hover'), [now, was, apart] = hover.replace('−', '-').match(/-?\d[\d.]*(?=,| lx| W)/g).map(Number);
    check(now < was && Math.abs(now - was - apart) <= 0.02 * was, `and values: ${hover}`);
    await keep('compare_difference');
    const blue = await page.evaluate(async () => {
        const image = new Image();
        image.src = exitance.canvas();
        await image.decode();
        const canvas = new OffscreenCanvas(image.width, image.height), context = canvas.getContext('2d');
        context.drawImage(image, 0, 0);
        const p = context.getImageData(0, 0, image.width, image.height).data;
        let blue = 0, red = 0;
        for (let i = 0; i < p.length; i += 4) p[i + 2] > p[i] + 20 ? ++blue : p[i] > p[i + 2] + 20 ? ++red : 0;
        return 4 * (blue - red) / p.length;
    });
    check(blue > 0.3, `dimmed light is blue: ${(100 * blue).toFixed(0)}% more of the pixels than red`);
    await page.fill('#difference_to', '1');
    check(await page.textContent('#legend') !== legend, 'the range can be chosen');
    await page.selectOption('#other', '');
    check(await page.isHidden('#compare_ways') && await page.textContent('#panes') === '', 'and nothing is compared again');
    await page.goto('about:blank');
    program.kill();
}

/** A page to share has the light, the hidden objects and the view of the page that it was made of, and asks nobody. */
async function check_share(page, solution) {
    const {program, origin} = await start(solution), file = path.join(folder, 'shared.html');
    const keep = async name => { if (process.env.KEEP) await page.screenshot({path: path.join(process.env.KEEP, name + '.png')}); };
    await page.goto(origin);
    await page.waitForFunction('document.body.dataset.whatif');
    await page.evaluate(() => document.querySelectorAll('details').forEach(d => { d.open = true; }));
    await page.selectOption('#source', 'delivered');
    await page.focus('#group_0');
    for (let i = 0; i < 60; ++i) await page.keyboard.press('ArrowLeft');
    await page.waitForFunction(() => /:0.4/.test(JSON.parse(document.body.dataset.refilled ?? '{}').change?.dim));
    await page.fill('#material_0', '#c04040');
    await page.waitForFunction(() => JSON.parse(document.body.dataset.refilled).change.paint);
    await page.uncheck('#object_1');
    await page.focus('#exposure');
    for (let i = 0; i < 10; ++i) await page.keyboard.press('ArrowRight');
    await page.click('#save_view');
    await page.focus('#picture');
    for (let i = 0; i < 3; ++i) { await page.keyboard.press('ArrowLeft'); await page.waitForTimeout(60); }
    const shown = await page.evaluate(() => exitance.canvas());
    await keep('share_before');
    const [download] = await Promise.all([page.waitForEvent('download'), page.click('#share')]);
    await download.saveAs(file);
    await page.goto('about:blank');
    program.kill();
    const foreign = [];
    page.on('request', r => { if (!/^(file|data|blob):/.test(r.url())) foreign.push(r.url()); });
    await page.goto('file://' + file);
    await page.waitForFunction('document.body.dataset.ready');
    const apart = await difference(page, shown, await page.evaluate(() => exitance.canvas()));
    check(apart < 0.002 && foreign.length === 0, `a shared page of ${(fs.statSync(file).size / 1e6).toFixed(1)} MB differs by ${(100 * apart).toFixed(2)}% of white, and calls nobody`);
    await page.evaluate(() => document.querySelectorAll('details').forEach(d => { d.open = true; }));
    check(await page.isVisible('#views_list >> text=View 1') && await page.isHidden('#how_section'), 'it has the saved views, and not what needs the program');
    await page.mouse.click(size[0] * 0.4, size[1] * 0.7);
    await page.waitForFunction(() => /lx|W\/m²/.test(document.getElementById('card').textContent));
    check(/material/.test(await page.textContent('#card')), 'and answers: ' + (await page.textContent('#card')).slice(0, 60));
    await keep('share_after');
    const written = path.join(folder, 'written.html'), views = path.join(folder, 'views.json');
    fs.writeFileSync(views, JSON.stringify([{name: 'from </script>', camera: '1.5,1.2,1.2;2.5,2,1;70'}]));
    execFileSync(exitance, ['view', solution, '-o', written, '--views', views, '-q']);
    await page.goto('file://' + written);
    await page.waitForFunction('document.body.dataset.ready');
    check(/^1.5,1.2,1.2 /.test(await page.evaluate(() => exitance.words())), 'a page that view -o writes opens with its first view');
    await page.goto('about:blank');
}

/** An office with light groups, and the same office solved again, less accurately. */
async function check_office(page) {
    const obj = path.join(folder, 'office.obj'), first = path.join(folder, 'before.h5'), second = path.join(folder, 'after.h5');
    execFileSync(exitance, ['generate', 'office', 'nx=1', 'ny=1', 'nfurn=2', 'books=3', '-o', obj, '-q']);
    execFileSync(exitance, ['solve', obj, '-o', first, '--error', '0.05', '--light-groups', '-q']);
    execFileSync(exitance, ['solve', obj, '-o', second, '--error', '0.2', '-q']);
    await check_compare(page, first, second);
    await check_share(page, first);
}

/** A solve that would take long is stopped, and what it has is saved and can be shown. */
async function check_stop(page) {
    const saved = path.join(folder, 'stopped.h5');
    const {program, origin} = await start(scene, '--error', '0.0001', '--save', saved);
    await page.goto(origin);
    await page.waitForFunction('document.body.dataset.first', null, {timeout: 120000});
    await page.click('#stop');
    await page.waitForFunction('document.body.dataset.ended', null, {timeout: 120000});
    const said = await page.textContent('#phase');
    check(/^stopped: /.test(said) && !/reached/.test(said), `the end of a stopped solve: ${said}`);
    await page.click('#save');
    await page.waitForFunction(() => /saved/.test(document.getElementById('phase').textContent));
    program.kill();
    const told = JSON.parse(execFileSync(exitance, ['stats', saved, '--json']));
    check(told.relative_error_estimate > 0.0001, `a stopped solve is saved with its error of ${(100 * told.relative_error_estimate).toPrecision(2)}%`);
}

/** A shooting method tells who shoots. */
async function check_shots(page) {
    const {program, origin} = await start(scene, '--error', '0.02', '--method', 'progressive', '--save', path.join(folder, 'shot.h5'));
    await page.goto(origin);
    await page.waitForFunction(() => document.body.dataset.ended || Number(document.body.dataset.shooters) > 2, null, {timeout: 120000});
    check(Number(await page.evaluate('document.body.dataset.shooters')) > 0, 'who shoots is outlined');
    await page.goto('about:blank');  // the page would report that the server has ended
    program.kill();
}

async function check_scene(page) {
    const {program, origin} = await start(scene, '--error', '0.01', '--save', path.join(folder, 'saved.h5'));
    await page.goto(origin);
    await page.waitForFunction('document.body.dataset.first', null, {timeout: 120000});
    await page.waitForFunction('document.body.dataset.ended', null, {timeout: 120000});
    const snapshots = Number(await page.evaluate('document.body.dataset.snapshots'));
    check(snapshots >= 2, `a running solve showed its light ${snapshots} times`);
    const said = await page.textContent('#phase');
    check(/^reached: estimated error \d/.test(said), `the end of a solve: ${said}`);
    if (process.env.KEEP) await page.screenshot({path: path.join(process.env.KEEP, 'solved.png')});
    await page.click('#save');
    await page.waitForFunction(() => /saved/.test(document.getElementById('phase').textContent));
    check(fs.existsSync(path.join(folder, 'saved.h5')), 'its light is saved');
    program.kill();
    await check_stop(page);
    await check_shots(page);
}

(async () => {
    const browser = await chromium.launch({executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
        args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader']});
    const page = await browser.newPage({viewport: {width: size[0], height: size[1]}, bypassCSP: true});
    page.setDefaultTimeout(120000);  // milliseconds; exact pictures take long on a busy machine
    page.on('pageerror', error => check(false, 'page: ' + error));
    page.on('console', message => { if (message.type() === 'error') check(false, `console: ${message.text()} (${message.location().url})`); });
    await check_solution(page);
    await check_sliders(page);
    await check_office(page);
    await check_rooms(page);
    if (scene) await check_layers(page);
    if (scene) await check_scene(page);
    await browser.close();
    process.exit(failed > 0 ? 1 : 0);
})().catch(error => { console.log('FAILED: ' + error); process.exit(1); });
