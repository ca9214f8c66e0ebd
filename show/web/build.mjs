// Builds the page's program and writes it, compressed, to ../assets; with --check, says whether that is fresh.
import { build } from 'esbuild';
import { readFileSync, writeFileSync } from 'node:fs';
import { deflateRawSync, inflateRawSync } from 'node:zlib';

const ASSET = new URL('../assets/viewer.js.deflate', import.meta.url);

const { outputFiles } = await build({
  entryPoints: [new URL('src/main.js', import.meta.url).pathname],
  bundle: true,
  minify: true,
  format: 'iife',
  target: 'es2022',
  legalComments: 'inline',
  // The run time of exported modules reads files in Node; a page has its module in it.
  external: ['node:*'],
  loader: { '.css': 'text' },
  write: false,
});
const program = Buffer.from(outputFiles[0].contents);

if (process.argv.includes('--check')) {
  // Packed anew it may differ by zlib's version; what is packed may not.
  if (!inflateRawSync(readFileSync(ASSET)).equals(program)) {
    console.error('show/assets/viewer.js.deflate is out of date: run `npm ci && npm run build` in show/web');
    process.exit(1);
  }
  console.log('show/assets/viewer.js.deflate is fresh');
} else {
  const packed = deflateRawSync(program, { level: 9, memLevel: 9 });
  writeFileSync(ASSET, packed);
  console.log(`wrote show/assets/viewer.js.deflate: ${program.length} bytes, packed ${packed.length}`);
}
