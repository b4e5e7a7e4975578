// three.js: a prefiltered KTX2 cube as it is, or a lat-long .hdr that it filters itself.
import * as THREE from 'three';
import { HDRLoader } from 'three/addons/loaders/HDRLoader.js';
import { KTX2Loader } from 'three/addons/loaders/KTX2Loader.js';
import { read } from 'three/addons/libs/ktx-parse.module.js';
import { eye, FAR, FIELD_OF_VIEW_DEGREES, NEAR, sphere } from './view.js';

const VK_FORMAT_R16G16B16A16_SFLOAT = 97;
let renderer, scene, mesh, target;

async function load(size, files) {
  renderer = new THREE.WebGLRenderer();
  target = new THREE.WebGLRenderTarget(size, size, { type: THREE.FloatType });
  scene = new THREE.Scene();
  scene.environment = await environment(files);
  const { positions, indices } = sphere();
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(positions, 3));
  geometry.setIndex(new THREE.BufferAttribute(indices, 1));
  mesh = new THREE.Mesh(geometry);
  scene.add(mesh);
}

async function environment(files) {
  if (files['environment.hdr']) {
    const texture = await new HDRLoader().setDataType(THREE.FloatType).loadAsync(files['environment.hdr']);
    texture.mapping = THREE.EquirectangularReflectionMapping;
    return texture;
  }
  const url = files['specular.ktx2'];
  const bytes = new Uint8Array(await (await fetch(url)).arrayBuffer());
  const container = read(bytes);
  const texture = container.vkFormat === VK_FORMAT_R16G16B16A16_SFLOAT
    ? cubeOfHalfFloats(container)
    : await new KTX2Loader().detectSupport(renderer).loadAsync(url);
  texture.isPMREMTexture = true;
  return texture;
}

/** KTX2Loader takes cubes in block-compressed formats only; half floats go into the same texture class by hand. */
function cubeOfHalfFloats(container) {
  const faces = Array.from({ length: 6 }, () => ({ width: container.pixelWidth, height: container.pixelHeight, mipmaps: [] }));
  container.levels.forEach(({ levelData }, level) => {
    const width = Math.max(1, container.pixelWidth >> level);
    const halves = width * width * 4;
    const data = new Uint16Array(levelData.slice().buffer);
    faces.forEach((face, i) => face.mipmaps.push({ data: data.subarray(i * halves, (i + 1) * halves), width, height: width }));
  });
  const texture = new THREE.CompressedCubeTexture(faces, THREE.RGBAFormat, THREE.HalfFloatType);
  texture.minFilter = THREE.LinearMipmapLinearFilter;
  texture.magFilter = THREE.LinearFilter;
  texture.generateMipmaps = false;
  texture.needsUpdate = true;
  return texture;
}

async function draw({ view, material, roughness }) {
  mesh.material = material === 'metal'
    ? new THREE.MeshStandardMaterial({ color: 0xffffff, metalness: 1, roughness })
    : new THREE.MeshLambertMaterial({ color: 0xffffff });
  const camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW_DEGREES, 1, NEAR, FAR);
  camera.position.set(...eye(view));
  camera.lookAt(0, 0, 0);
  renderer.setRenderTarget(target);
  renderer.clear();
  renderer.render(scene, camera);
  const pixels = new Float32Array(target.width * target.height * 4);
  renderer.readRenderTargetPixels(target, 0, 0, target.width, target.height, pixels);
  mesh.material.dispose();
  return pixels;
}

window.engine = { load, draw };
