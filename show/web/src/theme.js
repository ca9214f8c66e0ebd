// Light or dark: the reader's system says which, a button says otherwise.

const THEMES = {
  light: { sky: 0xf4f5f7, ground: 0xe3e6ea, grid: 0xc9ced6, ink: '#30343a', faint: '#d5d9df', fixed: 0x8a929e, joint: 0x4a5260 },
  dark: { sky: 0x17191d, ground: 0x24282e, grid: 0x3a4049, ink: '#d5d9df', faint: '#33383f', fixed: 0x78818e, joint: 0xaab2be },
};

export function watchTheme(button) {
  const system = matchMedia('(prefers-color-scheme: dark)');
  const listeners = [];
  let chosen = null;
  const theme = {
    name: 'light',
    colours: THEMES.light,
    listen(listener) { listeners.push(listener); },
  };
  const apply = () => {
    theme.name = chosen ?? (system.matches ? 'dark' : 'light');
    theme.colours = THEMES[theme.name];
    document.documentElement.dataset.theme = theme.name;
    for (const listener of listeners) listener(theme);
  };
  system.addEventListener('change', apply);
  button.onclick = () => { chosen = theme.name === 'dark' ? 'light' : 'dark'; apply(); };
  apply();
  return theme;
}

// Told apart by most people with impaired colour vision, and restrained (after Paul Tol's "muted").
export const PALETTE = ['#4477aa', '#cc6677', '#228833', '#ccaa33', '#66a5c4', '#aa3377', '#dd8855', '#7766aa'];
