// Where one looks from. In a room one looks around and walks, and walls stop one; outside one turns about the scene.
// The place is kept in the address; paths can be recorded.
import * as THREE from 'three';
import type {Facts, Triple} from './data';
import type {Space} from './space';

const fly_keys: Record<string, Triple> = {w: [0, 0, -1], s: [0, 0, 1], a: [-1, 0, 0], d: [1, 0, 0], q: [0, -1, 0], e: [0, 1, 0]};
const turn_keys: Record<string, [number, number]> = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
const upwards = new THREE.Vector3(0, 0, 1);
const least_height = 1;    // metres of the eye above a floor; what is nearer is furniture
const most_stair = 0.35;  // metres by which the floor may rise or fall in one step of a walk

interface Station { time: number; eye: Triple; target: Triple; fov: number }

export class Viewpoint {
    readonly camera = new THREE.PerspectiveCamera(50, 1, 0.01, 1000);
    readonly target = new THREE.Vector3();
    /** Horizontal angle, degrees, as `render` takes it. */
    fov = 60;
    /** True in a room: drags look around instead of turning the scene. */
    inside = false;
    path: Station[] = [];
    recording = false;
    private down = new Set<string>();
    private pointers = new Map<number, {x: number; y: number; shift: boolean}>();
    private started = 0;
    private fitted = 0;
    private settling = 0;

    constructor(private facts: Facts, private canvas: HTMLCanvasElement, private space: () => Space | null, private changed: () => void) {
        this.camera.up.copy(upwards);
        const size = this.size();
        this.camera.near = size / 5000, this.camera.far = size * 20;
        canvas.addEventListener('keydown', event => this.press(event));
        canvas.addEventListener('keyup', event => this.down.delete(event.key.toLowerCase()));
        canvas.addEventListener('blur', () => this.down.clear());
        canvas.addEventListener('contextmenu', event => event.preventDefault());
        canvas.addEventListener('pointerdown', event => {
            canvas.setPointerCapture(event.pointerId);
            this.pointers.set(event.pointerId, {x: event.clientX, y: event.clientY, shift: event.button !== 0 || event.shiftKey});
        });
        canvas.addEventListener('pointermove', event => this.drag(event));
        for (const end of ['pointerup', 'pointercancel'] as const) canvas.addEventListener(end, event => this.pointers.delete(event.pointerId));
        canvas.addEventListener('wheel', event => this.roll(event), {passive: false});
        if (!this.from_address()) this.set(facts.camera.eye, facts.camera.target, facts.camera.fov);
        window.addEventListener('hashchange', () => { this.from_address(); changed(); });
    }

    get dragging(): boolean { return this.pointers.size > 0; }

    size(): number {
        const [low, high] = this.facts.box;
        return Math.max(1e-6, Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]));
    }

    set(eye: Triple, target: Triple, fov: number): void {
        this.fov = fov;
        this.camera.position.set(...eye);
        this.target.set(...target);
        this.aim();
        this.resize(this.camera.aspect);
    }

    /** Turns the camera to its target, and finds out if it is in a room. */
    private aim(): void {
        this.camera.lookAt(this.target);
        this.camera.updateMatrixWorld();
        this.find_place();
    }

    /** To be called when there is a new mesh, too. */
    find_place(): void { this.inside = this.space()?.is_inside(this.camera.position) ?? this.inside; }

    private settled(): void {
        this.aim();
        this.changed();
        window.clearTimeout(this.settling);
        this.settling = window.setTimeout(() => this.to_address(), 200);
    }

    resize(aspect: number): void {
        if (aspect === this.camera.aspect && this.fov === this.fitted) return;
        this.camera.aspect = aspect, this.fitted = this.fov;
        this.camera.fov = 2 * Math.atan(Math.tan(this.fov * Math.PI / 360) / aspect) * 180 / Math.PI;
        this.camera.updateProjectionMatrix();
    }

    /** The eye and the target of a view of the whole scene from a direction. */
    whole_from(away: THREE.Vector3): [Triple, Triple] {
        const [low, high] = this.facts.box.map(p => new THREE.Vector3(...p)), middle = low.clone().add(high).multiplyScalar(0.5);
        const half = Math.min(this.camera.fov, this.fov) * Math.PI / 360;
        const eye = middle.clone().addScaledVector(away.clone().normalize(), 0.5 * this.size() / Math.sin(half));
        return [eye.toArray() as Triple, middle.toArray() as Triple];
    }

    private ahead(): THREE.Vector3 { return this.target.clone().sub(this.camera.position).normalize(); }

    /** The point that the scene turns about: what one looks at, unless that is outside of the scene. */
    private pivot(): THREE.Vector3 {
        if (this.inside) return this.camera.position;
        const box = new THREE.Box3(...this.facts.box.map(p => new THREE.Vector3(...p)) as [THREE.Vector3, THREE.Vector3]);
        return box.containsPoint(this.target) ? this.target.clone() : box.getCenter(new THREE.Vector3());
    }

    /** Turns eye and target about the pivot, by angles about the vertical and about the picture's horizontal. */
    private turn(about: number, up: number): void {
        const pivot = this.pivot().clone(), ahead = this.ahead(), right = ahead.clone().cross(upwards).normalize();
        const rotation = new THREE.Quaternion().setFromAxisAngle(upwards, about);
        const tilted = ahead.clone().applyAxisAngle(right, up);
        if (Math.abs(tilted.z) < 0.995) rotation.multiply(new THREE.Quaternion().setFromAxisAngle(right, up));
        for (const p of [this.camera.position, this.target]) p.sub(pivot).applyQuaternion(rotation).add(pivot);
        this.settled();
    }

    /** Moves eye and target; in a room walls stop them. */
    private move(way: THREE.Vector3, walks: boolean): void {
        const before = this.camera.position.clone(), space = this.inside ? this.space() : null;
        if (space) {
            const height = walks ? space.above_floor(before) : null, gap = Math.min(0.25, 0.03 * this.size());
            space.walk(this.camera.position, way, gap);
            const now = height === null ? null : space.above_floor(this.camera.position);
            if (height !== null && now !== null && Math.min(height, now) > least_height && Math.abs(now - height) < most_stair && Math.abs(now - height) > 1e-4)
                space.walk(this.camera.position, new THREE.Vector3(0, 0, height - now), gap);
        } else {
            this.camera.position.add(way);
        }
        this.target.add(this.camera.position).sub(before);
        this.settled();
    }

    /** Length of a usual step, metres. */
    private step(): number { return this.inside ? Math.min(0.35, 0.04 * this.size()) : 0.04 * this.size(); }

    private drag(event: PointerEvent): void {
        const last = this.pointers.get(event.pointerId);
        if (!last) return;
        const dx = event.clientX - last.x, dy = event.clientY - last.y;
        if (dx === 0 && dy === 0) return;
        const others = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, p]) => p);
        last.x = event.clientX, last.y = event.clientY;
        if (others.length > 0) return this.pinch(dx, dy, others[0], event);
        if (last.shift) return this.shift(dx, dy);
        const k = this.fov * Math.PI / 180 / this.canvas.clientWidth;
        if (this.inside) this.turn(dx * k, dy * k);
        else this.turn(-2 * Math.PI * dx / this.canvas.clientHeight, -2 * Math.PI * dy / this.canvas.clientHeight);
    }

    /** The picture follows the pointer sideways. */
    private shift(dx: number, dy: number): void {
        const distance = this.inside ? 8 * this.step() : this.camera.position.distanceTo(this.target);
        const k = 2 * distance * Math.tan(this.fov * Math.PI / 360) / this.canvas.clientWidth;
        this.move(new THREE.Vector3(-dx * k, dy * k, 0).applyQuaternion(this.camera.quaternion), false);
    }

    /** Two fingers: apart to come closer, together to go away. */
    private pinch(dx: number, dy: number, other: {x: number; y: number}, event: PointerEvent): void {
        const now = Math.hypot(event.clientX - other.x, event.clientY - other.y);
        const before = Math.hypot(event.clientX - dx - other.x, event.clientY - dy - other.y);
        this.approach((now - before) / 40, this.ahead());
        this.shift(dx / 2, dy / 2);
    }

    /** Comes closer by some steps: on foot in a room, by shares of the distance outside. */
    private approach(steps: number, direction: THREE.Vector3): void {
        if (this.inside) {
            const flat = direction.clone().setZ(0);
            if (flat.length() > 1e-6) this.move(flat.normalize().multiplyScalar(steps * this.step()), true);
            return;
        }
        const offset = this.camera.position.clone().sub(this.pivot());
        this.move(offset.multiplyScalar(0.9 ** steps - 1), false);
    }

    private roll(event: WheelEvent): void {
        event.preventDefault();
        const x = 2 * event.offsetX / this.canvas.clientWidth - 1, y = 1 - 2 * event.offsetY / this.canvas.clientHeight;
        const pointed = new THREE.Vector3(x, y, 0.5).unproject(this.camera).sub(this.camera.position).normalize();
        this.approach(-Math.sign(event.deltaY) * Math.min(3, Math.max(0.3, Math.abs(event.deltaY) / 100)), pointed);
    }

    private press(event: KeyboardEvent): void {
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        const key = event.key.toLowerCase(), turn = turn_keys[event.key];
        if (fly_keys[key]) { this.down.add(key); this.changed(); }
        if (turn) {
            event.preventDefault();
            const step = 0.06, sign = this.inside ? -1 : 1;
            this.turn(sign * step * turn[0], sign * step * turn[1]);
        }
        if (key === '+' || key === '=') this.approach(1, this.ahead());
        if (key === '-') this.approach(-1, this.ahead());
    }

    /** One step of walking or flying; true while a key is down. */
    fly(seconds: number): boolean {
        if (this.down.size === 0) return false;
        const way = new THREE.Vector3();
        for (const key of this.down) way.add(new THREE.Vector3(...fly_keys[key]));
        const speed = 6 * this.step() * Math.min(seconds, 0.1), rise = way.y;
        if (this.inside) way.y = 0;
        way.applyQuaternion(this.camera.quaternion);
        if (this.inside) {
            way.setZ(0);
            if (way.length() > 1e-6) this.move(way.normalize().multiplyScalar(speed), rise === 0);
            if (rise !== 0) this.move(new THREE.Vector3(0, 0, rise * speed), false);
        } else {
            this.move(way.multiplyScalar(speed), false);
        }
        return true;
    }

    /** Eye, target and angle. */
    numbers(): number[] {
        return [...this.camera.position.toArray(), ...this.target.toArray(), this.fov].map(x => Number(x.toPrecision(7)));
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
        return found !== null && this.from_words(found[1]);
    }

    /** Takes a camera as words() or an address has it; false if it is none. */
    from_words(words: string): boolean {
        const numbers = words.split(/[;, ]/).map(Number);
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
        this.path.push({time, eye: this.camera.position.toArray() as Triple, target: this.target.toArray() as Triple, fov: this.fov});
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
