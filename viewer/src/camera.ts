// Where one looks from: turning about a target, flying, fitting, the place kept in the address, paths.
import * as THREE from 'three';
import {OrbitControls} from 'three/examples/jsm/controls/OrbitControls.js';
import type {Facts, Triple} from './data';

const fly_keys: Record<string, Triple> = {w: [0, 0, -1], s: [0, 0, 1], a: [-1, 0, 0], d: [1, 0, 0], q: [0, -1, 0], e: [0, 1, 0]};

interface Station { time: number; eye: Triple; target: Triple; fov: number }

export class Viewpoint {
    readonly camera = new THREE.PerspectiveCamera(50, 1, 0.01, 1000);
    readonly controls: OrbitControls;
    /** Horizontal angle, degrees, as `render` takes it. */
    fov = 60;
    private down = new Set<string>();
    path: Station[] = [];
    recording = false;
    private started = 0;
    private fitted = 0;

    constructor(private facts: Facts, canvas: HTMLCanvasElement, private changed: () => void) {
        this.camera.up.set(0, 0, 1);
        this.controls = new OrbitControls(this.camera, canvas);
        this.controls.addEventListener('change', () => changed());
        const size = this.size();
        this.camera.near = size / 5000, this.camera.far = size * 20;
        canvas.addEventListener('keydown', event => {
            const key = event.key.toLowerCase();
            if (fly_keys[key] && !event.ctrlKey && !event.metaKey) { this.down.add(key); changed(); }
        });
        canvas.addEventListener('keydown', event => this.turn_by_key(event));
        canvas.addEventListener('keyup', event => this.down.delete(event.key.toLowerCase()));
        canvas.addEventListener('blur', () => this.down.clear());
        if (!this.from_address()) this.set(facts.camera.eye, facts.camera.target, facts.camera.fov);
        window.addEventListener('hashchange', () => { this.from_address(); changed(); });
    }

    private size(): number {
        const [low, high] = this.facts.box;
        return Math.max(1e-6, Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]));
    }

    set(eye: Triple, target: Triple, fov: number): void {
        this.fov = fov;
        this.camera.position.set(...eye);
        this.controls.target.set(...target);
        this.controls.update();
        this.resize(this.camera.aspect);
    }

    resize(aspect: number): void {
        if (aspect === this.camera.aspect && this.fov === this.fitted) return;
        this.camera.aspect = aspect, this.fitted = this.fov;
        this.camera.fov = 2 * Math.atan(Math.tan(this.fov * Math.PI / 360) / aspect) * 180 / Math.PI;
        this.camera.updateProjectionMatrix();
    }

    fit(): void {
        const [low, high] = this.facts.box.map(p => new THREE.Vector3(...p));
        const middle = low.clone().add(high).multiplyScalar(0.5);
        const away = this.camera.position.clone().sub(this.controls.target).normalize();
        const half = Math.min(this.camera.fov, this.fov) * Math.PI / 360;
        const eye = middle.clone().addScaledVector(away, 0.5 * this.size() / Math.sin(half));
        this.set(eye.toArray() as Triple, middle.toArray() as Triple, this.fov);
        this.changed();
    }

    /** One step of flying; true while a key is down. */
    fly(seconds: number): boolean {
        if (this.down.size === 0) return false;
        const way = new THREE.Vector3();
        for (const key of this.down) way.add(new THREE.Vector3(...fly_keys[key]));
        way.applyQuaternion(this.camera.quaternion).multiplyScalar(0.25 * this.size() * Math.min(seconds, 0.1));
        this.camera.position.add(way);
        this.controls.target.add(way);
        this.controls.update();
        return true;
    }

    /** Arrows turn about the target, + and - come closer and go away. */
    private turn_by_key(event: KeyboardEvent): void {
        const turns: Record<string, [number, number, number]> = {ArrowLeft: [-1, 0, 1], ArrowRight: [1, 0, 1],
            ArrowUp: [0, -1, 1], ArrowDown: [0, 1, 1], '+': [0, 0, 0.9], '=': [0, 0, 0.9], '-': [0, 0, 1 / 0.9]};
        const turn = turns[event.key];
        if (!turn || event.ctrlKey || event.metaKey) return;
        event.preventDefault();
        const away = this.camera.position.clone().sub(this.controls.target), step = 0.06;
        const length = away.length(), pole = Math.min(Math.max(Math.acos(away.z / length) + step * turn[1], 0.02), Math.PI - 0.02);
        const round = Math.atan2(away.y, away.x) + step * turn[0];
        away.set(Math.sin(pole) * Math.cos(round), Math.sin(pole) * Math.sin(round), Math.cos(pole)).multiplyScalar(length * turn[2]);
        this.camera.position.copy(this.controls.target).add(away);
        this.controls.update();
        this.changed();
    }

    /** Eye, target and angle. */
    numbers(): number[] {
        return [...this.camera.position.toArray(), ...this.controls.target.toArray(), this.fov].map(x => Number(x.toPrecision(7)));
    }

    /** As --camera of `render` takes it. */
    words(): string {
        const n = this.numbers();
        return `${n.slice(0, 3)} ${n.slice(3, 6)} ${n[6]}`;
    }

    to_address(): void {
        history.replaceState(null, '', '#camera=' + this.words().replaceAll(' ', ';'));
    }

    private from_address(): boolean {
        const found = /^#camera=(.*)$/.exec(decodeURIComponent(location.hash));
        const numbers = found ? found[1].split(/[;,]/).map(Number) : [];
        if (numbers.length !== 7 || !numbers.every(Number.isFinite) || numbers[6] < 1 || numbers[6] > 170) return false;
        this.set(numbers.slice(0, 3) as Triple, numbers.slice(3, 6) as Triple, numbers[6]);
        return true;
    }

    record(): void {
        this.recording = !this.recording;
        if (this.recording) this.path = [], this.started = performance.now();
    }

    keep(): void {
        const time = (performance.now() - this.started) / 1000;
        if (!this.recording || (this.path.length > 0 && time < this.path[this.path.length - 1].time + 0.04)) return;
        this.path.push({time, eye: this.camera.position.toArray() as Triple,
            target: this.controls.target.toArray() as Triple, fov: this.fov});
    }

    replay(): void {
        const begin = performance.now();
        const step = () => {
            const time = (performance.now() - begin) / 1000;
            const next = this.path.find(s => s.time >= time) ?? this.path[this.path.length - 1];
            if (!next) return;
            this.set(next.eye, next.target, next.fov);
            this.changed();
            if (time < this.path[this.path.length - 1].time) requestAnimationFrame(step);
        };
        step();
    }

    /** What `exitance render --path` reads. */
    path_text(): string {
        return 'time,ex,ey,ez,tx,ty,tz,fov\n' +
            this.path.map(s => [s.time.toFixed(3), ...s.eye, ...s.target, s.fov].join(',')).join('\n') + '\n';
    }
}
