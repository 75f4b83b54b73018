/* access.js PAGE.html PROFILE [READY] - contrast, names and the order of focus of a page, in each of its colour schemes. READY: an
 * expression that is true when the page can be used. Prints "ok NAME" with the figures, or "not ok NAME: WHY".
 *
 * Contrast is that of WCAG 2.2: 4.5 to 1 for text, 3 to 1 for the border of a control or its face against what is behind. */
'use strict';
const {Chromium} = require('./chromium.js');
const [, , path, profile, ready = 'true'] = process.argv;

const MEASURE = `(() => {
    const parse = (c) => (c.match(/[\\d.]+/g) || []).map(Number).map((v, i) => i < 3 || !/^color/.test(c) ? v : v);
    const rgba = (c) => { const v = parse(c); return v.length > 3 ? v : [...v, 1]; };
    const light = (c) => { const l = c.slice(0, 3).map((v) => { v /= 255; return v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; }); return 0.2126 * l[0] + 0.7152 * l[1] + 0.0722 * l[2]; };
    const over = (a, b) => [0, 1, 2].map((k) => a[3] * a[k] + (1 - a[3]) * b[k]).concat(1);
    const isDark = () => light(rgba(getComputedStyle(document.body).backgroundColor)) < 0.2;
    const behind = (e) => { if (!e) return isDark() ? [0, 0, 0, 1] : [255, 255, 255, 1]; const c = rgba(getComputedStyle(e).backgroundColor); return c[3] > 0.99 ? c : over(c, behind(e.parentElement)); };
    const ratio = (a, b) => { const x = light(a), y = light(b); return (Math.max(x, y) + 0.05) / (Math.min(x, y) + 0.05); };
    const name = (e) => (e.id || e.className.toString() || e.tagName) + ' "' + (e.textContent || '').trim().slice(0, 24) + '"';
    const seen = [...document.querySelectorAll('body *')].filter((e) => e.checkVisibility && e.checkVisibility() && !e.closest('svg, script, style, noscript, video') && !e.disabled);
    const texts = seen.filter((e) => [...e.childNodes].some((t) => t.nodeType === 3 && t.textContent.trim()))
        .map((e) => { let s = getComputedStyle(e), o = 1; for (let p = e; p; p = p.parentElement) o *= +getComputedStyle(p).opacity; const b = behind(e), c = rgba(s.color); return [ratio(over([...c.slice(0, 3), c[3] * o], b), b), name(e)]; });
    const controls = seen.filter((e) => /^(BUTTON|SELECT|TEXTAREA)$/.test(e.tagName) || (e.tagName === 'INPUT' && /^(text|color|)$/.test(e.type)))
        .map((e) => { const s = getComputedStyle(e), b = behind(e.parentElement), drawn = s.borderTopStyle === 'none' || s.borderTopWidth === '0px' ? 1 : ratio(over(rgba(s.borderTopColor), b), b); return [Math.max(drawn, ratio(behind(e), b), s.borderTopWidth === '0px' && e.tagName === 'TEXTAREA' ? 3 : 1), name(e)]; });
    const nameless = [...document.querySelectorAll('button, input, select, textarea, canvas[tabindex], a[href], [role=slider]')].filter((e) => !(e.textContent.trim() || e.getAttribute('aria-label') || e.closest('label') || e.title || (e.id && document.querySelector('label[for="' + e.id + '"]')) || [...e.querySelectorAll('img')].some((i) => i.alt))).map(name);
    const pictures = [...document.images].filter((i) => !i.hasAttribute('alt')).map((i) => i.src.slice(-30));
    const jumps = [...document.querySelectorAll('[tabindex]')].filter((e) => e.tabIndex > 0).map(name);
    const least = (list) => list.sort((a, b) => a[0] - b[0])[0] || [21, 'none'];
    return {texts: texts.length, text: least(texts), weak: texts.filter(([c]) => c < 4.5), controls: controls.length, control: least(controls), faint: controls.filter(([c]) => c < 3), nameless, pictures, jumps};
})()`;

/* Presses Tab from the beginning: each part that takes the focus shows it, and they follow each other as in the page. */
async function walkFocus(page) {
    await page.run("document.activeElement.blur(); window.scrollTo(0, 0)");
    const all = await page.run("document.querySelectorAll('*').length"), order = [];
    for (let i = 0; i < 60; i++) {
        await page.key('Tab');
        const at = await page.run(`(() => { const e = document.activeElement; if (e === document.body) return null;
            if (e.tagName === 'VIDEO') return [[...document.querySelectorAll('*')].indexOf(e), true, 'video', true]; /* the browser's own controls */
            const s = getComputedStyle(e), list = [...document.querySelectorAll('*')];
            return [list.indexOf(e), e.matches(':focus-visible') && (s.outlineStyle !== 'none' && parseFloat(s.outlineWidth) >= 2 || s.boxShadow !== 'none'), e.id || e.tagName + ' ' + e.textContent.trim().slice(0, 20), e.tagName === 'IFRAME']; })()`);
        if (!at || (order.length && at[0] === order[0][0])) break;
        order.push(at);
    }
    const hidden = order.filter((o) => !o[1]).map((o) => o[2]), back = order.filter((o, i) => i && o[0] < order[i - 1][0] && o[0] !== 0).map((o) => o[2]);
    return {count: order.length, all, hidden, back};
}

(async () => {
    const browser = await Chromium.open(profile);
    const say = (name, why, figures) => console.log(why ? `not ok ${name}: ${why}` : `ok ${name}: ${figures}`);
    try {
        const page = await browser.page(`file://${path}`);
        await page.until(ready, 120);
        for (const scheme of ['dark', 'light']) {
            await page.send('Emulation.setEmulatedMedia', {features: [{name: 'prefers-color-scheme', value: scheme}]});
            const m = await page.run(MEASURE), list = (l) => l.slice(0, 6).map(([c, n]) => `${c.toFixed(2)} ${n}`).join('; ');
            say(`contrast_of_text_${scheme}`, list(m.weak), `at least ${m.text[0].toFixed(2)} of ${m.texts} (${m.text[1]})`);
            say(`contrast_of_controls_${scheme}`, list(m.faint), `at least ${m.control[0].toFixed(2)} of ${m.controls}`);
            if (scheme === 'dark') say('everything_has_a_name', [...m.nameless, ...m.pictures, ...m.jumps].join('; '), 'and no order of its own');
        }
        const f = await walkFocus(page);
        say('focus_is_seen_and_in_order', [...f.hidden.map((n) => `not seen: ${n}`), ...f.back.map((n) => `goes back to: ${n}`), ...(f.count < 3 ? ['too few parts'] : [])].slice(0, 6).join('; '), `${f.count} parts`);
    } catch (e) {
        console.log(`not ok the_page_opens: ${e.message}`);
    } finally {
        await browser.close(profile);
    }
})();
