// Babylon.js: .env, DDS, or a glTF asset that carries its lighting (EXT_lights_image_based).
// `options.handedness` is that of the scene. The world is where Babylon's glTF loader puts it: (-x, y, z) in a left-handed
// scene, unchanged in a right-handed one. The two differ by half a turn against what lights them, so one file for both is
// turned by `rotationY` in the latter.
import { Engine } from '@babylonjs/core/Engines/engine.js';
import { Scene } from '@babylonjs/core/scene.js';
import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { Color3, Color4 } from '@babylonjs/core/Maths/math.color.js';
import { FreeCamera } from '@babylonjs/core/Cameras/freeCamera.js';
import { Mesh } from '@babylonjs/core/Meshes/mesh.js';
import { VertexData } from '@babylonjs/core/Meshes/mesh.vertexData.js';
import { CubeTexture } from '@babylonjs/core/Materials/Textures/cubeTexture.js';
import { RenderTargetTexture } from '@babylonjs/core/Materials/Textures/renderTargetTexture.js';
import { PBRMaterial } from '@babylonjs/core/Materials/PBR/pbrMaterial.js';
import { LoadAssetContainerAsync } from '@babylonjs/core/Loading/sceneLoader.js';
import '@babylonjs/core/Materials/Textures/Loaders/envTextureLoader.js';
import '@babylonjs/core/Materials/Textures/Loaders/ddsTextureLoader.js';
import '@babylonjs/core/Engines/Extensions/engine.prefilteredCubeTexture.js';
import '@babylonjs/core/Materials/Textures/baseTexture.polynomial.js';
import '@babylonjs/loaders/glTF/index.js';
import { eye, FAR, FIELD_OF_VIEW_DEGREES, NEAR, sphere } from './view.js';

const FLOAT = 1; // Constants.TEXTURETYPE_FLOAT
let scene, mesh, material, target, camera;

async function load(size, files, { handedness }) {
  const canvas = document.createElement('canvas');
  // The camera takes its aspect ratio from here.
  canvas.width = canvas.height = size;
  const engine = new Engine(canvas, false);
  scene = new Scene(engine);
  scene.useRightHandedSystem = handedness === 'right';
  scene.clearColor = new Color4(0, 0, 0, 0);
  // Radiance as it is: what follows in the picture pipeline is left to post-processes, of which there are none.
  scene.imageProcessingConfiguration.applyByPostProcess = true;
  camera = new FreeCamera('camera', Vector3.Zero(), scene);
  camera.fov = (FIELD_OF_VIEW_DEGREES * Math.PI) / 180;
  camera.minZ = NEAR;
  camera.maxZ = FAR;
  target = new RenderTargetTexture('picture', size, scene, { type: FLOAT, generateMipMaps: false });
  target.activeCamera = camera;
  scene.customRenderTargets.push(target);
  await environment(files);
  mesh = ball();
  target.renderList = [mesh];
}

async function environment(files) {
  const [name, url] = Object.entries(files)[0];
  const extension = name.slice(name.lastIndexOf('.'));
  if (extension === '.glb') {
    await LoadAssetContainerAsync(url, scene);
    if (scene.environmentTexture === null) throw new Error('the asset brought no environment');
    // The loader decodes RGBD into linear half floats and leaves the texture marked as gamma-encoded (9.28): without this
    // line radiance L is drawn as L^2.2.
    scene.environmentTexture.gammaSpace = false;
  } else {
    scene.environmentTexture = CubeTexture.CreateFromPrefilteredData(url, scene, extension);
  }
  const texture = scene.environmentTexture;
  if (scene.useRightHandedSystem) texture.rotationY = Math.PI;
  while (!texture.isReady()) await new Promise((done) => setTimeout(done, 10));
}

function ball() {
  const { positions, indices } = sphere();
  const data = new VertexData();
  data.positions = positions;
  data.normals = positions;
  data.indices = indices;
  const ball = new Mesh('ball', scene);
  data.applyToMesh(ball);
  material = new PBRMaterial('material', scene);
  material.backFaceCulling = false;
  material.albedoColor = Color3.White();
  ball.material = material;
  return ball;
}

async function draw({ view, material: kind, roughness }) {
  material.metallic = kind === 'metal' ? 1 : 0;
  material.roughness = roughness;
  // Nothing specular remains of the white one.
  material.metallicF0Factor = kind === 'metal' ? 1 : 0;
  camera.position = Vector3.FromArray(eye(view));
  camera.setTarget(Vector3.Zero());
  while (!scene.isReady() || !target.isReadyForRendering()) await new Promise((done) => setTimeout(done, 10));
  scene.render();
  const pixels = await target.readPixels();
  return new Float32Array(pixels.buffer, pixels.byteOffset, pixels.length);
}

window.engine = { load, draw };
