/* store.js - nothing that was typed is lost: changes are kept in the browser until they are saved, to the scene's folder
 * where the browser can, else as downloads. */
'use strict';

class Store {
    constructor(scene, texts, masks) {
        this.key = 'remodel draw ' + scene;
        this.texts = texts;
        this.masks = masks;
        this.scene = scene;
        this.onDisk = {...texts.now}; /* as the page was made, or saved since */
        this.folder = null;
        window.addEventListener('beforeunload', (e) => { if (this.unsaved().length) e.preventDefault(); });
        texts.watch(() => this.keep());
    }

    unsaved() {
        const names = new Set([...Object.keys(this.onDisk), ...Object.keys(this.texts.now)]);
        return [...names].filter((name) => this.onDisk[name] !== this.texts.now[name]);
    }

    keep() {
        const kept = {};
        for (const name of this.unsaved()) kept[name] = {from: this.onDisk[name] ?? null,
            to: this.texts.now[name] ?? null};
        try {
            if (Object.keys(kept).length) localStorage.setItem(this.key, JSON.stringify(kept));
            else localStorage.removeItem(this.key);
        } catch (e) { /* without storage the guard before closing remains */ }
    }

    /* Takes back what was not saved. Returns the names of these files. */
    restore() {
        let kept = {};
        try { kept = JSON.parse(localStorage.getItem(this.key) || '{}'); } catch (e) { return []; }
        const names = Object.keys(kept).filter((name) => (kept[name].to ?? undefined) !== this.onDisk[name]);
        for (const name of names) this.texts.put(name, kept[name].to ?? undefined);
        this.changedSince = names.filter((name) => kept[name].from !== (this.onDisk[name] ?? null));
        return names;
    }

    /* What is to be written of these files: [path, text or bytes]. What was drawn on masks becomes pictures. */
    async contents(names) {
        const list = names.filter((n) => n !== 'masks.txt').map((n) => [n, this.texts.now[n]]);
        if (names.includes('masks.txt'))
            for (const id of this.masks.ids(`${this.onDisk['masks.txt'] || ''}\n${this.texts.now['masks.txt']}`))
                if (this.masks.draw(id, 8)) list.push([`masks/${id}.png`, await this.masks.png(id)]);
        return list;
    }

    /* Returns what was done, as a sentence. */
    async save() {
        const names = this.unsaved().filter((name) => this.texts.now[name] !== undefined);
        if (!names.length) return 'Nothing to save.';
        const before = {...this.texts.now};
        if (window.showDirectoryPicker)
            this.folder = this.folder || await window.showDirectoryPicker({id: 'remodel', mode: 'readwrite'});
        const list = await this.contents(names), files = list.map(([path]) => path);
        for (const [path, what] of list)
            if (this.folder) await this.writeTo(this.folder, path.split('/'), what);
            else this.download(path.split('/').pop(), what);
        for (const name of names) this.onDisk[name] = before[name];
        this.keep();
        if (this.folder) return `Saved ${files.join(', ')} in the folder ${this.folder.name}.`;
        const deeper = ['edits', 'masks'].filter((f) => files.some((n) => n.startsWith(f + '/')));
        return `Downloaded ${files.join(', ')}: put ${files.length > 1 ? 'them' : 'it'} into scenes/${this.scene}/` +
            `${deeper.map((f) => `, those of ${f} into its folder ${f}`).join('')}.`;
    }

    async writeTo(folder, parts, text) {
        if (parts.length > 1) return this.writeTo(await folder.getDirectoryHandle(parts[0], {create: true}),
            parts.slice(1), text);
        const file = await (await folder.getFileHandle(parts[0], {create: true})).createWritable();
        await file.write(text);
        await file.close();
    }

    download(name, text) {
        const link = document.createElement('a');
        link.href = URL.createObjectURL(new Blob([text]));
        link.download = name;
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 60000);
    }
}
