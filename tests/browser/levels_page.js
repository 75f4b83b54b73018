// node levels_page.js LUX EDIT - opens the page of light levels, LUX/index.html, in Chromium; EDIT: one of its edits.
//
// What the page adds up is what sheet.tsv says; lamps are linear; hours, edits and points are reached by keys. Names,
// contrast, width on a phone, links, size on disk, and an empty console; without scripts all pictures are linked.
'use strict';
const fs = require('fs');
const os = require('os');
const path = require('path');
const {Chromium} = require('./chromium.js');
const {CONTRAST, NAMELESS, deadLinks, phoneWidth, checkSize} = require('./page_checks.js');
const folder = path.resolve(process.argv[2]), edit = process.argv[3], html = path.join(folder, 'index.html');
let failed = 0;
const check = (name, fine, why) => {
    console.log(`${fine ? 'ok' : 'not ok'} ${name}${fine ? '' : `: ${why}`}`);
    failed += !fine;
};

// Rows of work planes and places by state: {state: {"KIND PLACE": {mean, least, most, difference}}}
const sheetOf = (file) => {
    const [head, ...rows] = fs.readFileSync(file, 'utf8').trim().split('\n').filter((l) => l[0] !== '#')
        .map((l) => l.split('\t'));
    const found = {};
    for (const r of rows) {
        const row = Object.fromEntries(head.map((h, i) => [h, r[i]]));
        if (row.kind !== 'work-plane' && row.kind !== 'place') continue;
        (found[row.state] = found[row.state] || {})[`${row.kind} ${row.place}`] = row;
    }
    return found;
};

const set = (id, value) => `(() => {
    const e = document.getElementById('${id}');
    e.value = '${value}';
    for (const name of ['input', 'change']) e.dispatchEvent(new Event(name, {bubbles: true}));
})()`;
const press = (id) => `document.getElementById('${id}').click()`;
const ROWS = `(() => {
    const p = window.levelsPage, v = p.variants[p.choice.edit];
    return v.rows(v.values(p.choice)).map((r) => ({...r, key: r.kind + ' ' + r.name}));
})()`;
const TABLE = '[...document.querySelectorAll("#values tbody tr")].map((r) => [...r.cells].map((c) => c.textContent))';

const near = (a, b) => Math.abs(a - b) <= 0.003 * Math.abs(b) + 1e-4;

const compare = async (page, name, state, sheet) => {
    const rows = await page.run(ROWS), wanted = sheet[state];
    const bad = rows.filter((r) => !wanted[r.key] || !near(r.mean, +wanted[r.key].mean) ||
        !near(r.least, +wanted[r.key].least) || !near(r.most, +wanted[r.key].most));
    check(name, rows.length > 0 && !bad.length, JSON.stringify([bad[0], bad[0] && wanted[bad[0].key]]));
};

const tryTheSums = async (page, sheet) => {
    await compare(page, 'the_page_begins_with_the_photographed_light', 'photographed', sheet);
    await page.run(set('sky', 'none'));
    await compare(page, 'without_a_sky_the_lamps_are_left', 'lamps', sheet);
    await page.run(set('sky', 'photographed') + ';' + press('off'));
    await compare(page, 'lamps_off_leaves_daylight', 'daylight', sheet);
    await page.run(set('sky', 'overcast'));
    await compare(page, 'an_overcast_sky_is_that_of_the_sheet', 'overcast', sheet);
    if (sheet.planned) {
        const number = await page.run('[...document.querySelectorAll("#lamps label")].findIndex((l) => /planned/.test(l.textContent))');
        await page.run(set('sky', 'none') + ';' + set(`lamp${number}`, 100));
        await compare(page, 'a_planned_lamp_shines_without_a_scale', 'planned', sheet);
        await page.run(set(`lamp${number}`, 0));
    }
    await page.run(set('sky', 'none') + ';' + press('on'));
    const full = await page.run(ROWS);
    await page.run('document.querySelectorAll("#lamps input").forEach((e) => { e.value = e.value > 0 ? 50 : 0; ' +
        'e.dispatchEvent(new Event("input")); })');
    const half = await page.run(ROWS);
    check('dimmed_lamps_give_half', full.every((r, i) => near(2 * half[i].mean, r.mean)), JSON.stringify(half[0]));
    await page.run(press('on'));
};

const tryTheHours = async (page) => {
    await page.run(set('sky', 'hour'));
    await page.run('document.getElementById("hour").focus()');
    const look = `({clock: document.getElementById('clock').textContent, said: document.getElementById('said').textContent,
        value: document.getElementById('hour').getAttribute('aria-valuetext')})`;
    const noon = await page.run(look);
    for (let i = 0; i < 4; i++) await page.key('ArrowRight');
    const later = await page.run(look);
    check('arrow_keys_change_the_hour', noon.clock === '12:00' && later.clock === '14:00', JSON.stringify([noon, later]));
    check('the_light_changes_with_the_hour', noon.said !== later.said && /lx/.test(later.said), later.said);
    check('the_hour_says_how_high_the_sun_is', /14:00, the sun is -?\d+ degrees high/.test(later.value), later.value);
    const days = await page.run('[...document.getElementById("day").options].map((o) => o.textContent)');
    check('solstices_and_equinox_are_there', ['21 December', '21 March', '21 June'].every((d) => days.includes(d)),
        days.join(' '));
    await page.run(set('sky', 'photographed'));
};

const tryTheEdit = async (page, sheet) => {
    const number = await page.run(`[...document.getElementById('edit').options].find((o) => o.textContent ===
        ${JSON.stringify(edit.replace(/[-_]/g, ' '))}).value`);
    await page.run(set('edit', number));
    await compare(page, 'the_edit_has_its_own_sheet', 'photographed', sheet);
    const table = await page.run(TABLE), first = Object.values(sheet.photographed)[0];
    const differs = Number(table[0][7].replace('−', '-').replace('+', ''));
    check('the_table_has_the_difference', Math.abs(differs - +first.difference) <= 0.006 * Math.abs(+first.difference),
        `${table[0].join(' ')}; wanted ${first.difference}`);
    const ticks = 'document.getElementById("ticks").textContent';
    await page.run(set('show', 'difference'));
    check('the_difference_has_a_key_in_words', /as before/.test(await page.run(ticks)), await page.run(ticks));
    await page.run(set('show', 'after'));
    await page.run('document.getElementById("plan").focus()');
    await page.key('ArrowRight');
    const one = await page.run('document.getElementById("point").textContent');
    await page.key('ArrowRight');
    const two = await page.run('document.getElementById("point").textContent');
    check('arrow_keys_read_points_of_the_plan', /At this point/.test(one) && /At this point/.test(two), `${one} ${two}`);
    await page.run(set('edit', 0));
};

// Mean, least and most of each edit, in each state that every scene has, are those of its sheet.
const tryAllEdits = async (page) => {
    const STATES = [['photographed', 'photographed', 'on'], ['lamps', 'none', 'on'], ['daylight', 'photographed', 'off'],
        ['overcast', 'overcast', 'off']];
    const edits = await page.run('[...document.getElementById("edit").options].map((o) => [o.value, o.textContent])');
    const folders = fs.readdirSync(folder).filter((f) => fs.existsSync(path.join(folder, f, 'sheet.tsv')));
    let rows = 0, worst = [0, ''];
    for (const [value, words] of edits) {
        const own = folders.find((f) => f.replace(/[-_]/g, ' ') === words);
        const sheet = sheetOf(path.join(folder, own || '', 'sheet.tsv'));
        await page.run(set('edit', value));
        for (const [state, sky, lamps] of STATES) {
            await page.run(set('sky', sky) + ';' + press(lamps));
            for (const r of await page.run(ROWS)) {
                const wanted = sheet[state] && sheet[state][r.key];
                if (!wanted) continue; // lamps and sky in one unit: the sheet has no such row
                for (const what of ['mean', 'least', 'most']) {
                    const off = Math.abs(r[what] - +wanted[what]) / Math.max(Math.abs(+wanted[what]), 1e-2);
                    if (off > worst[0]) worst = [off, `${what} of ${r.key} in ${state}, ${words}: ${r[what]}, wanted ${wanted[what]}`];
                }
                rows++;
            }
        }
    }
    await page.run(set('edit', 0) + ';' + set('sky', 'photographed') + ';' + press('on'));
    check('all_edits_have_the_values_of_their_sheets', edits.length === folders.length + 1 && rows >= 4 * edits.length &&
        worst[0] <= 0.005, `${rows} rows of ${edits.length} edits, ${folders.length} sheets; ${worst[1]}`);
    console.log(`# ${edits.length - 1} edits, ${rows} rows, off by at most ${(100 * worst[0]).toFixed(2)} %: ${worst[1]}`);
};

const tryThePictures = async (page) => {
    const states = await page.run('[...document.getElementById("state").options].map((o) => o.value)');
    await page.run(set('state', states[1]));
    const shots = await page.run('[...document.querySelectorAll("#shots img")].map((i) => [i.getAttribute("src"), i.alt])');
    check('a_state_has_pictures_of_photographs', shots.length > 0 && shots.every((s) => s[0].startsWith(`${states[1]}.`) &&
        s[1].includes('Photograph')), JSON.stringify(shots));
    check('a_picture_loads', await page.run('(async () => { const i = document.querySelector("#shots img"); ' +
        'await i.decode(); return i.naturalWidth; })()') > 0, 'it does not');
};

// Photographs follow lamps, blinds and hours; exposed as photographed, their own light gives the photograph back.
const tryThePhotographs = async (page) => {
    const LUMA = `(() => { const all = [...document.querySelectorAll('#relit canvas')].map((c) => {
        const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
        let s = 0;
        for (let i = 0; i < d.length; i += 4) s += d[i] + d[i + 1] + d[i + 2];
        return s / d.length; });
        return {all, words: [...document.querySelectorAll('#relit figcaption')].map((e) => e.textContent)}; })()`;
    const settled = 'window.levelsPage.relit.busy === false && document.querySelectorAll("#relit canvas").length > 0';
    const look = async (...acts) => {
        for (const act of acts) await page.run(act);
        await page.until(settled);
        return page.run(LUMA);
    };
    const own = await look(set('exposure', 'photo'), set('sky', 'photographed'), press('on'));
    const base = await page.run(`Promise.all(window.levelsPage.relit.lights[0] && [window.levelsPage.relit.lights[0]])
        .then(([photos]) => photos.map((p) => p.photo.jpeg.length))`);
    check('photographs_are_drawn', own.all.length > 0 && own.all.length === base.length && own.all.every((v) => v > 5) &&
        own.words.every((w) => /exposed 1 times/.test(w)), JSON.stringify(own));
    const dark = await look(set('sky', 'none'), press('off'));
    check('without_light_they_say_so', dark.words.every((w) => /no light/.test(w)) && dark.all.every((v, i) => v < own.all[i]),
        JSON.stringify(dark));
    const day = await look(set('exposure', 'own'), set('sky', 'overcast'));
    const shut = await look(set('exposure', 'kept'), set('blind0', 20));
    check('a_blind_darkens_them', shut.all.some((v, i) => v < 0.98 * day.all[i]), JSON.stringify([day.all, shut.all]));
    await look(set('blind0', 100), set('sky', 'photographed'), press('on'), set('exposure', 'own'));
};

const tryWithoutScripts = async (browser) => {
    const page = await browser.page('about:blank');
    await page.send('Emulation.setScriptExecutionDisabled', {value: true});
    await page.send('Page.navigate', {url: `file://${html}`});
    await new Promise((done) => setTimeout(done, 500));
    const found = await page.run(`(() => {
        const shown = (s) => [...document.querySelectorAll(s)].some((e) => e.offsetParent);
        return {links: shown('.plain a'), canvas: shown('#plan')};
    })()`);
    check('without_scripts_all_pictures_are_linked', found.links && !found.canvas, JSON.stringify(found));
};

const main = async () => {
    const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'levels-browser-'));
    const browser = await Chromium.open(profile);
    const sheet = sheetOf(path.join(folder, 'sheet.tsv')), edited = sheetOf(path.join(folder, edit, 'sheet.tsv'));
    try {
        const page = await browser.page(`file://${html}`, 1280, 900);
        const dead = await deadLinks(page, html), nameless = await page.run(NAMELESS);
        check('all_links_lead_somewhere', !dead.length, dead.join(' '));
        check('all_pictures_and_controls_have_names', !nameless.length, nameless.join(' '));
        for (const scheme of ['light', 'dark']) {
            await page.send('Emulation.setEmulatedMedia', {features: [{name: 'prefers-color-scheme', value: scheme}]});
            const [ratio, where] = await page.run(CONTRAST);
            check(`${scheme}_text_has_contrast`, ratio >= 4.5, `${ratio} in ${where}`);
        }
        await tryTheSums(page, sheet);
        await tryTheHours(page);
        await tryTheEdit(page, edited);
        await tryAllEdits(page);
        await tryThePictures(page);
        await tryThePhotographs(page);
        check('the_console_is_empty', !page.errors.length, page.errors.join(' | '));
        const width = await phoneWidth(browser, `file://${html}`);
        check('the_page_fits_a_phone', width <= 390, `it is ${width} px wide`);
        await tryWithoutScripts(browser);
        const links = await page.run('[...document.querySelectorAll(".plain a")].map((a) => a.getAttribute("href"))');
        const relit = ['', ...fs.readdirSync(folder)].map((f) => path.join(f, 'relit.js'))
            .filter((f) => fs.existsSync(path.join(folder, f)));
        const size = [...new Set([...links.map(decodeURIComponent), 'index.html', ...relit])]
            .reduce((s, f) => s + fs.statSync(path.join(folder, f)).size, 0);
        checkSize(check, size * 2 / (relit.length || 2)); // of the room and one edit
        console.log(`# all of it: ${(size / 1e6).toFixed(2)} MB, ${fs.statSync(html).size / 1e6} MB of them the page`);
    } finally {
        await browser.close(profile);
    }
    process.exit(failed ? 1 : 0);
};
main().catch((e) => {
    console.log(`not ok the_page: ${e.stack}`);
    process.exit(1);
});
