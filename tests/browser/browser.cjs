// What the checks in a browser share: a server of files, the browser, and the comparison of pictures.
const fs = require('fs'), http = require('http'), path = require('path');
const {chromium} = require('playwright-core');

const types = {'.html': 'text/html', '.js': 'text/javascript', '.json': 'application/json', '.glb': 'model/gltf-binary',
    '.png': 'image/png'};

/** Serves a folder, and npm's packages in the folder `cache` below /node_modules. */
function serve(folder, cache) {
    const server = http.createServer((request, response) => {
        const name = decodeURIComponent(request.url.split('?')[0]);
        const file = path.join(name.startsWith('/node_modules/') ? cache : folder, name);
        if (!fs.existsSync(file)) return response.writeHead(404).end();
        response.writeHead(200, {'content-type': types[path.extname(file)] || 'application/octet-stream'});
        response.end(fs.readFileSync(file));
    });
    return new Promise(done => server.listen(0, '127.0.0.1', () => done(server)));
}

/** Starts Chromium without a display, with graphics in software. */
function launch() {
    return chromium.launch({executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
        args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader']});
}

/** Script for a page: window.compare(a, b) of two addresses of pictures. */
const compare_pictures = `const pixels = async url => {
    const image = new Image();
    image.src = url;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height), context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, image.width, image.height).data;
};
// Mean difference of two pictures as a share of white, and the share of pixels that differ by more than 0.1.
window.compare = async (a, b) => {
    const [p, q] = [await pixels(a), await pixels(b)];
    let sum = 0, far = 0;
    for (let i = 0; i < p.length; i += 4) {
        const d = (Math.abs(p[i] - q[i]) + Math.abs(p[i + 1] - q[i + 1]) + Math.abs(p[i + 2] - q[i + 2])) / 765;
        sum += d, far += d > 0.1;
    }
    return [4 * sum / p.length, 4 * far / p.length];
};`;

module.exports = {compare_pictures, launch, serve};
