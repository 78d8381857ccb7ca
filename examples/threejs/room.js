// Shows a model of `bake --moz-lightmap --light-groups` with a slider for each light group.
// Address: index.html?maps=FOLDER&camera=EX,EY,EZ TX,TY,TZ ANGLE, with the camera of `exitance render` (Z up).
import * as THREE from 'three';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {EXRLoader} from 'three/addons/loaders/EXRLoader.js';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import {LightGroups} from './light_groups.js';

const parameters = new URLSearchParams(location.search);
const folder = parameters.get('maps') || 'maps';
const renderer = new THREE.WebGLRenderer({canvas: document.getElementById('view'), antialias: true, preserveDrawingBuffer: true});
const scene = new THREE.Scene();
const camera = new THREE.PerspectiveCamera(60, 1, 0.01, 1000);
const controls = new OrbitControls(camera, renderer.domElement);
let angle = 75;  // horizontal, degrees

/** Turns (x, y, z) with Z up into the axes of glTF. */
const y_up = p => new THREE.Vector3(p[0], p[2], -p[1]);

/** Places the camera as the address says, or in a corner of the model at 0.6 of its height. */
function place_camera(model) {
    const words = parameters.get('camera');
    if (words) {
        const [eye, target, degrees] = words.split(' ').map(word => word.split(',').map(Number));
        camera.position.copy(y_up(eye));
        controls.target.copy(y_up(target));
        angle = degrees[0];
    } else {
        const box = new THREE.Box3().setFromObject(model), size = box.getSize(new THREE.Vector3());
        camera.position.copy(box.min).add(size.clone().multiply(new THREE.Vector3(0.1, 0.6, 0.9)));
        box.getCenter(controls.target);
    }
    controls.update();
}

function draw() {
    const {clientWidth: width, clientHeight: height} = renderer.domElement;
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.fov = 2 * Math.atan(Math.tan(angle * Math.PI / 360) / camera.aspect) * 180 / Math.PI;
    camera.updateProjectionMatrix();
    renderer.render(scene, camera);
}

function add_slider(groups, i) {
    const label = document.createElement('label'), input = document.createElement('input'), value = document.createElement('output');
    Object.assign(input, {type: 'range', min: 0, max: 2, step: 0.01, value: 1, name: groups.names[i]});
    value.value = '1.00';
    input.addEventListener('input', () => {
        groups.factors[i] = Number(input.value);
        value.value = groups.factors[i].toFixed(2);
        groups.update(renderer);
        draw();
    });
    label.append(groups.names[i], input, value);
    document.getElementById('sliders').append(label);
}

async function main() {
    const response = await fetch(`${folder}/lightmaps.json`);
    if (!response.ok) throw new Error(`${folder}/lightmaps.json is missing: bake into ${folder} beside this page`);
    const manifest = await response.json();
    const loader = new EXRLoader();
    loader.setDataType(THREE.FloatType);
    const [groups, gltf] = await Promise.all([LightGroups.load(manifest, loader, folder),
        new GLTFLoader().loadAsync(`${folder}/${manifest.model}`)]);
    await groups.show(gltf);
    scene.add(gltf.scene);
    groups.names.forEach((name, i) => add_slider(groups, i));
    groups.update(renderer);
    place_camera(gltf.scene);
    controls.addEventListener('change', draw);
    addEventListener('resize', draw);
    draw();
    document.body.dataset.ready = 'yes';
}

main().catch(error => { document.getElementById('message').textContent = error.message; });
