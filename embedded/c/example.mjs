// The same second as in example.c, in JavaScript: node example.mjs gimbal.wasm
import { readFileSync } from "node:fs";

const module = new WebAssembly.Module(readFileSync(process.argv[2]));
const imports = WebAssembly.Module.imports(module);
if (imports.length > 0) throw new Error(`imports: ${JSON.stringify(imports)}`);
const wasm = new WebAssembly.Instance(module).exports;

// As in gimbal.h.
const status = { ok: 0, badPointer: 1, notInitialised: 2, outOfRange: 3, badNumber: 4 };
const words = 226, massOfRotor = 0, torqueOfMotor = 0;

// Memory beyond all that the module itself uses.
const gimbal = (wasm.__heap_base.value + 7) & ~7;
const angle = gimbal + 8 * words;
const missing = angle + 16 - wasm.memory.buffer.byteLength;
if (missing > 0) wasm.memory.grow(Math.ceil(missing / 65536));
const memory = new DataView(wasm.memory.buffer);

const bits = (value) => {
    const view = new DataView(new ArrayBuffer(8));
    view.setFloat64(0, value);
    return view.getBigUint64(0);
};
// FNV-1a, 64 bits.
const digest = (hash, value) => {
    for (let byte = 0n; byte < 8n; byte++) {
        hash = BigInt.asUintN(64, (hash ^ ((value >> (8n * byte)) & 255n)) * 0x100000001b3n);
    }
    return hash;
};
const expect = (expected, found) => {
    if (found !== expected) throw new Error(`status ${found} where ${expected} was expected`);
};
const torque = (interval) => (interval < 600 ? 1e-4 : interval < 1200 ? -1e-4 : 0);

const blank = wasm.gimbal_step(gimbal, 1e-4, 5);
expect(status.notInitialised, blank);
expect(status.ok, wasm.gimbal_init(gimbal));
expect(status.ok, wasm.gimbal_set_parameter(gimbal, massOfRotor, 0.085));
let hash = 0xcbf29ce484222325n;
const positions = [0, 0, 0];
for (let interval = 0; interval < 2000; interval++) {
    expect(status.ok, wasm.gimbal_set_input(gimbal, torqueOfMotor, torque(interval)));
    expect(status.ok, wasm.gimbal_step(gimbal, 1e-4, 5));
    for (let joint = 0; joint < 3; joint++) {
        expect(status.ok, wasm.gimbal_read_joint(gimbal, joint, angle));
        const [position, rate] = [memory.getFloat64(angle, true), memory.getFloat64(angle + 8, true)];
        positions[joint] = position;
        hash = digest(digest(hash, bits(position)), bits(rate));
    }
}
const hex = (value) => value.toString(16).padStart(16, "0");
console.log("run f64 driven", hex(hash), ...positions.map((position) => hex(bits(position))));

expect(status.badPointer, wasm.gimbal_step(0, 1e-4, 5));
expect(status.badPointer, wasm.gimbal_step(gimbal + 1, 1e-4, 5));
expect(status.badNumber, wasm.gimbal_step(gimbal, NaN, 5));
expect(status.badNumber, wasm.gimbal_set_input(gimbal, torqueOfMotor, NaN));
expect(status.outOfRange, wasm.gimbal_read_joint(gimbal, 3, angle));
console.log("end");
