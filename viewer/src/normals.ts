// Normals of faces, by which the shader tells fronts from backs.
import {face_words, six_nodes} from './data';

/** Unit normals of all vertices, as whole numbers of 1/32767, four a vertex. */
export function normals_of(positions: Float32Array, faces: Uint32Array, first: Uint32Array): Int16Array {
    const count = positions.length / 3, out = new Int16Array(4 * count), n = [0, 0, 0];
    for (let f = 0; f < first.length; ++f) {
        const corners = faces[face_words * f] === six_nodes ? 3 : faces[face_words * f], begin = first[f], end = f + 1 < first.length ? first[f + 1] : count;
        n.fill(0);
        for (let i = 0; i < corners; ++i) {
            // Newell's sum, about the first corner.
            const p = 3 * (begin + i), q = 3 * (begin + (i + 1) % corners), o = 3 * begin;
            for (let c = 0; c < 3; ++c) {
                const d = (c + 1) % 3, e = (c + 2) % 3;
                n[c] += (positions[p + d] - positions[o + d]) * (positions[q + e] - positions[o + e]) -
                    (positions[p + e] - positions[o + e]) * (positions[q + d] - positions[o + d]);
            }
        }
        const length = Math.hypot(n[0], n[1], n[2]) || 1;
        for (let v = begin; v < end; ++v) for (let c = 0; c < 3; ++c) out[4 * v + c] = Math.round(32767 * n[c] / length);
    }
    return out;
}
