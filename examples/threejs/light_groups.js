// Light maps of light groups, summed on the graphics card: map = sum of factor times map of group.
import * as THREE from 'three';

/** One light map of a bake, W/m^2: its groups' maps and the sum that materials show. */
class SummedMap {
    /** textures: a map per group, of one size. */
    constructor(textures) {
        this.textures = textures;
        const {width, height} = textures[0].image;
        this.target = new THREE.WebGLRenderTarget(width, height, {type: THREE.HalfFloatType, depthBuffer: false});
    }

    /** Draws each group's map over the sum of the former ones. */
    update(renderer, factors) {
        renderer.setRenderTarget(this.target);
        renderer.setClearColor(0, 0);
        renderer.clear();
        const autoClear = renderer.autoClear;
        renderer.autoClear = false;
        this.textures.forEach((texture, i) => {
            quad.material.uniforms.map.value = texture;
            quad.material.uniforms.factor.value = factors[i];
            if (factors[i] > 0) renderer.render(quad, camera);
        });
        renderer.autoClear = autoClear;
        renderer.setRenderTarget(null);
    }
}

const camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);
const quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), new THREE.ShaderMaterial({
    uniforms: {map: {value: null}, factor: {value: 1}},
    vertexShader: 'varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0., 1.); }',
    fragmentShader: 'uniform sampler2D map; uniform float factor; varying vec2 at;' +
        'void main() { gl_FragColor = vec4(factor * texture2D(map, at).rgb, 1.); }',
    blending: THREE.CustomBlending, blendEquation: THREE.AddEquation, blendSrc: THREE.OneFactor, blendDst: THREE.OneFactor,
    depthTest: false, depthWrite: false,
}));
quad.frustumCulled = false;

/** The light of a baked model by light group. */
export class LightGroups {
    /** manifest: lightmaps.json; loader: an EXRLoader; folder: address of the files. */
    static async load(manifest, loader, folder) {
        if (!manifest.groups) throw new Error('lightmaps.json has no light groups: use solve and bake with --light-groups');
        const maps = await Promise.all(manifest.maps.map(async (map, i) => {
            const textures = await Promise.all(manifest.groups.map(group => loader.loadAsync(`${folder}/${group.files[i]}`)));
            for (const texture of textures) {
                texture.flipY = true;  // the loader turns pictures over
                texture.generateMipmaps = false;
                texture.minFilter = texture.magFilter = THREE.NearestFilter;  // texels are copied one to one
            }
            return new SummedMap(textures);
        }));
        return new LightGroups(manifest, maps);
    }

    constructor(manifest, maps) {
        this.names = manifest.groups.map(group => group.name);
        this.factors = this.names.map(() => 1);
        this.exposure = manifest.exposure;
        this.maps = maps;
        this.lamps = [];
    }

    /** Gives a loaded model the summed maps. Lamps of a group become materials of their own, which are dimmed with it. */
    async show(gltf) {
        const json = gltf.parser.json;
        const meshes = [];
        gltf.scene.traverse(thing => { if (thing.isMesh) meshes.push(thing); });
        for (const mesh of meshes) {
            const description = json.materials[gltf.parser.associations.get(mesh.material).materials];
            const light = description.extensions?.MOZ_lightmap;
            if (light) {
                const image = json.images[json.textures[light.index].source].name;  // lightmap_0, lightmap_1, ...
                mesh.material.lightMap = this.maps[Number(image.split('_').pop())].target.texture;
                mesh.material.lightMap.channel = light.texCoord;
                mesh.material.lightMapIntensity = Math.PI * this.exposure;  // three.js divides by pi
            }
            const group = this.names.findIndex(name => [mesh, mesh.parent].some(node => node.userData.name === name));
            if (group >= 0 && description.emissiveFactor) {
                mesh.material = mesh.material.clone();
                this.lamps.push({material: mesh.material, group, full: mesh.material.emissiveIntensity});
            }
        }
    }

    /** Computes all maps for the present factors. */
    update(renderer) {
        for (const map of this.maps) map.update(renderer, this.factors);
        for (const {material, group, full} of this.lamps) material.emissiveIntensity = full * this.factors[group];
    }
}
