// Renders a list of pictures in engines that run in a browser: node render.mjs JOBS.json
//
// JOBS.json: { browser, out, size, scenes: [ { engine, files: { name: path }, options, pictures: [ { name, ... } ] } ] }.
// Each scene loads its files into a fresh page of its engine (pages/ENGINE.html), which then draws the pictures one after
// another. A picture arrives as size * size RGBA f32, linear, bottom row first as WebGL reads it, and is written to
// OUT/NAME.f32. Every problem, console errors of the page included, goes to stderr and ends with exit code 1.
import { readFile, writeFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';

const ROOT = path.dirname(fileURLToPath(import.meta.url));
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm', '.json': 'application/json' };
// No GPU is assumed: WebGL2 runs on SwiftShader.
const FLAGS = ['--no-sandbox', '--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader', '--enable-unsafe-swiftshader', '--use-angle=swiftshader'];
// The slowest scene measured took a small part of this; a page that hangs must end.
const SCENE_TIMEOUT_MS = 180_000;

const jobs = JSON.parse(await readFile(process.argv[2], 'utf8'));
const files = new Map();
const server = createServer((request, response) => answer(request, response).catch((error) => {
  response.writeHead(404).end(String(error));
}));
await new Promise((done) => server.listen(0, '127.0.0.1', done));
const origin = `http://127.0.0.1:${server.address().port}`;
const browser = await chromium.launch({ executablePath: jobs.browser, args: FLAGS });
let failed = false;
try {
  for (const scene of jobs.scenes) await draw(scene);
} catch (error) {
  console.error(error.stack ?? String(error));
  failed = true;
} finally {
  await browser.close();
  server.close();
}
process.exitCode = failed ? 1 : 0;

/** Serves this folder, and under /files/ what the scene at hand names. */
async function answer(request, response) {
  const { pathname } = new URL(request.url, origin);
  const named = pathname.startsWith('/files/') ? files.get(decodeURIComponent(pathname.slice(7))) : undefined;
  const file = named ?? path.join(ROOT, path.normalize(pathname));
  const body = await readFile(file);
  response.writeHead(200, { 'content-type': TYPES[path.extname(file)] ?? 'application/octet-stream', 'cache-control': 'no-store' });
  response.end(body);
}

async function draw(scene) {
  files.clear();
  for (const [name, file] of Object.entries(scene.files)) files.set(name, file);
  const page = await browser.newPage();
  page.setDefaultTimeout(SCENE_TIMEOUT_MS);
  const errors = [];
  page.on('pageerror', (error) => errors.push(error.message));
  page.on('console', (message) => {
    if (message.type() === 'error') errors.push(message.text());
    if (process.env.LUMISPHERE_ENGINES_LOG) console.error(`[${scene.engine}] ${message.text()}`);
  });
  const label = `${scene.engine} ${Object.keys(scene.files).join(' ')}`;
  await page.goto(`${origin}/pages/${scene.engine}.html`);
  try {
    await page.waitForFunction(() => window.engine !== undefined);
    const urls = Object.fromEntries(Object.keys(scene.files).map((name) => [name, `/files/${encodeURIComponent(name)}`]));
    await withTimeout(label, page.evaluate(([size, urls, options]) => window.engine.load(size, urls, options), [jobs.size, urls, scene.options ?? {}]));
    for (const picture of scene.pictures) {
      const pixels = await withTimeout(`${label} ${picture.name}`, page.evaluate(drawInPage, picture));
      await writeFile(path.join(jobs.out, `${picture.name}.f32`), Buffer.from(pixels, 'base64'));
    }
  } catch (error) {
    throw new Error(`${label}: ${error.message}\n${errors.join('\n')}`);
  }
  if (errors.length > 0) throw new Error(`${label}: the page reports\n${errors.join('\n')}`);
  await page.close();
}

/** Runs in the page: pixels as base64, in pieces that fit an argument list. */
async function drawInPage(picture) {
  const bytes = new Uint8Array((await window.engine.draw(picture)).buffer);
  let text = '';
  for (let at = 0; at < bytes.length; at += 0x8000) text += String.fromCharCode(...bytes.subarray(at, at + 0x8000));
  return btoa(text);
}

function withTimeout(label, promise) {
  let timer;
  const late = new Promise((_, reject) => {
    timer = setTimeout(() => reject(new Error(`${label}: no answer within ${SCENE_TIMEOUT_MS / 1000} s`)), SCENE_TIMEOUT_MS);
  });
  return Promise.race([promise, late]).finally(() => clearTimeout(timer));
}
