// What is around the eye: distances to surfaces, whether the eye is in a room, and steps that end at walls.
import * as THREE from 'three';
import type {Elements} from './elements';

export interface Wall { distance: number; normal: THREE.Vector3; front: boolean }

/** Directions evenly spread over the sphere. */
const around: THREE.Vector3[] = Array.from({length: 60}, (_, i) => {
    const z = 1 - (2 * i + 1) / 60, r = Math.sqrt(1 - z * z), turn = i * Math.PI * (3 - Math.sqrt(5));
    return new THREE.Vector3(r * Math.cos(turn), r * Math.sin(turn), z);
});

/** Horizontal directions. */
const sideways: THREE.Vector3[] = Array.from({length: 16}, (_, i) => new THREE.Vector3(Math.cos(i * Math.PI / 8), Math.sin(i * Math.PI / 8), 0));

export class Space {
    constructor(private elements: Elements) {}

    /** The first surface along a ray of unit direction, at most `reach` away. */
    nearest(from: THREE.Vector3, direction: THREE.Vector3, reach = Infinity): Wall | null {
        const ray = new THREE.Ray(from.clone(), direction);
        let best: Wall | null = null;
        for (const tree of this.elements.trees()) {
            const hit = tree.raycastFirst(ray, THREE.DoubleSide);
            if (!hit || !hit.face || hit.distance > reach || (best && hit.distance >= best.distance)) continue;
            const along = hit.face.normal.dot(direction);
            best = {distance: hit.distance, normal: hit.face.normal.clone().multiplyScalar(along > 0 ? -1 : 1), front: along < 0};
        }
        return best;
    }

    /** True if surfaces show the eye their fronts nearly everywhere: at least half of all directions, and few backs. */
    is_inside(eye: THREE.Vector3): boolean {
        let fronts = 0, backs = 0;
        for (const direction of around) {
            const wall = this.nearest(eye, direction);
            if (wall) wall.front ? ++fronts : ++backs;
        }
        return fronts >= 0.5 * around.length && backs <= 0.15 * around.length;
    }

    /** Moves `eye` by `way`, no closer than `gap` to a surface: along walls where they are in the way. */
    walk(eye: THREE.Vector3, way: THREE.Vector3, gap: number): void {
        const rest = way.clone();
        for (let i = 0; i < 3 && rest.length() > 1e-9; ++i) {
            const length = rest.length(), direction = rest.clone().divideScalar(length);
            const wall = this.nearest(eye, direction, length + gap);
            const free = wall ? Math.min(length, Math.max(0, wall.distance - gap)) : length;
            eye.addScaledVector(direction, free);
            if (!wall) break;
            rest.multiplyScalar(1 - free / length);
            rest.addScaledVector(wall.normal, -rest.dot(wall.normal));
        }
        this.keep_away(eye, gap);
    }

    /** Keeps the gap to walls at the sides. Leaves the eye where it is if a narrow place allows no gap. */
    private keep_away(eye: THREE.Vector3, gap: number): void {
        for (const direction of sideways) {
            const wall = this.nearest(eye, direction, gap);
            if (!wall) continue;
            const back = gap - wall.distance, behind = this.nearest(eye, direction.clone().negate(), back + gap);
            eye.addScaledVector(direction, -Math.min(back, behind ? Math.max(0, behind.distance - gap) : back));
        }
    }

    /** Height of the eye above the floor below it; null without a floor. */
    above_floor(eye: THREE.Vector3): number | null {
        const floor = this.nearest(eye, new THREE.Vector3(0, 0, -1));
        return floor && floor.front && floor.normal.z > 0.7 ? floor.distance : null;
    }
}
