// Filament's build for the web: a KTX1 cube with its spherical harmonics in the key `sh`.
/* global Filament */
import { glb } from './glb.js';
import { eye, FAR, FIELD_OF_VIEW_DEGREES, NEAR, sphere } from './view.js';

const RGBA32F = 0x8814;
let engine, scene, view, camera, renderer, swapChain, instance, framebuffer, size;

async function load(pictureSize, files) {
  size = pictureSize;
  await new Promise((done) => Filament.init([], done));
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = size;
  const gl = canvas.getContext('webgl2', { antialias: false, depth: true, alpha: false });
  gl.getExtension('EXT_color_buffer_float');
  const texture = watchPictureTexture(gl);
  engine = Filament.Engine.create(canvas);
  scene = engine.createScene();
  swapChain = engine.createSwapChain();
  renderer = engine.createRenderer();
  camera = engine.createCamera(Filament.EntityManager.get().create());
  // Pre-exposure 1: a luminance of 1 arrives as 1.
  camera.setExposureDirect(1);
  camera.setProjectionFov(FIELD_OF_VIEW_DEGREES, 1, NEAR, FAR, Filament.Camera$Fov.VERTICAL);
  prepareView();
  await lighting(Object.values(files)[0]);
  await ball();
  render();
  if (texture.found === undefined) throw new Error('Filament made no picture texture of 32-bit floats');
  framebuffer = gl.createFramebuffer();
  const before = gl.getParameter(gl.READ_FRAMEBUFFER_BINDING);
  gl.bindFramebuffer(gl.READ_FRAMEBUFFER, framebuffer);
  gl.framebufferTexture2D(gl.READ_FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture.found, 0);
  gl.bindFramebuffer(gl.READ_FRAMEBUFFER, before);
}

/** Filament's binding has no way to read a texture back, so the WebGL texture is caught as it is made. */
function watchPictureTexture(gl) {
  const seen = {};
  const original = gl.texStorage2D.bind(gl);
  gl.texStorage2D = (where, levels, format, width, height) => {
    original(where, levels, format, width, height);
    if (where === gl.TEXTURE_2D && format === RGBA32F && width === size) seen.found = gl.getParameter(gl.TEXTURE_BINDING_2D);
  };
  return seen;
}

function prepareView() {
  view = engine.createView();
  view.setScene(scene);
  view.setCamera(camera);
  view.setViewport([0, 0, size, size]);
  view.setPostProcessingEnabled(false);
  const usage = Filament.Texture$Usage;
  const make = (format, flags) => Filament.Texture.Builder().width(size).height(size).levels(1)
    .sampler(Filament.Texture$Sampler.SAMPLER_2D).format(format).usage(flags).build(engine);
  const point = Filament.RenderTarget$AttachmentPoint;
  const target = Filament.RenderTarget.Builder()
    .texture(point.COLOR, make(Filament.Texture$InternalFormat.RGBA32F, usage.COLOR_ATTACHMENT.value | usage.SAMPLEABLE.value))
    .texture(point.DEPTH, make(Filament.Texture$InternalFormat.DEPTH24, usage.DEPTH_ATTACHMENT.value))
    .build(engine);
  view.setRenderTarget(target);
}

/** As createIblFromKtx1 does it, which leaves the harmonics for the caller to set. */
async function lighting(url) {
  const bytes = new Uint8Array(await (await fetch(url)).arrayBuffer());
  const { shfloats } = engine.createIblFromKtx1(bytes);
  const light = Filament.IndirectLight.Builder()
    .reflections(engine.createTextureFromKtx1(bytes))
    .irradianceSh(3, shfloats)
    .intensity(1)
    .build(engine);
  scene.setIndirectLight(light);
}

async function ball() {
  const asset = engine.createAssetLoader().createAsset(glb(sphere()));
  await new Promise((done) => asset.loadResources(done));
  scene.addEntities(asset.getEntities());
  const renderables = engine.getRenderableManager();
  instance = renderables.getMaterialInstanceAt(renderables.getInstance(asset.getRenderableEntities()[0]), 0);
}

/** Whether a frame was drawn: Filament skips frames while earlier ones are under way. */
function render() {
  const begun = renderer.beginFrame(swapChain);
  if (begun) {
    renderer.renderView(view);
    renderer.endFrame();
  }
  engine.execute();
  return begun;
}

async function draw({ view: side, material, roughness }) {
  instance.setFloatParameter('metallicFactor', material === 'metal' ? 1 : 0);
  instance.setFloatParameter('roughnessFactor', roughness);
  camera.lookAt(eye(side), [0, 0, 0], [0, 1, 0]);
  for (let frames = 0; frames < 3;) {
    if (render()) frames++;
    else await new Promise((done) => setTimeout(done, 10));
  }
  const gl = engine.context;
  const before = gl.getParameter(gl.READ_FRAMEBUFFER_BINDING);
  gl.bindFramebuffer(gl.READ_FRAMEBUFFER, framebuffer);
  const pixels = new Float32Array(size * size * 4);
  gl.readPixels(0, 0, size, size, gl.RGBA, gl.FLOAT, pixels);
  gl.bindFramebuffer(gl.READ_FRAMEBUFFER, before);
  return pixels;
}

window.engine = { load, draw };
