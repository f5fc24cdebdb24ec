"""Words of names, in the languages of those who draw sites, and what they say: closed, boundary, aircraft, ...

A pattern is a word or several with single spaces between them; `sperr*` stands for all words that begin so, `*verbot*`
for all names in which the letters stand. Chinese, Japanese, Korean, Arabic, Persian and Hebrew join words, so that
their patterns have a star on both sides. Accents, soft hyphens and joiners make no difference.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping
from functools import lru_cache

CLOSED, BOUNDARY, SURVEY, OBSTACLE = "closed", "boundary", "survey", "obstacle"
TASK, ROBOT, STATION, LANE, HOME = "task", "robot", "station", "lane", "home"
AIR, GROUND = "air", "ground"
FENCE = "fence"

_PATTERNS: Mapping[str, str] = {
    CLOSED: """
        no fly*, nofly*, nfz*, no go, nogo*, no entry, no access, no trespass*, no drone*, no uav*, no robot*,
        no drive*, no overflight*, do not enter, do not fly*, do not overfly, not allowed, not permitted, keep out*,
        keepout*, keep away, keep clear, stay out, stay away, off limits, out of bounds, prohibit*, forbid*,
        restrict*, exclusion*, exclude*, danger*, hazard*, unsafe, avoid, closed, minefield*, tfr, obstacle*, sperr*,
        *sperrgebiet*, *sperrzone*, *sperrflach*, *sperrbereich*, gesperrt*, *absperrung*, *beschrankung*,
        kein einflug, keine einfahrt, keine durchfahrt, kein zugang, blocked, drone free, gevaren*, exclusao,
        *fareomrad*, hinderomrad*, *yasag*, evitar, eviter, *verbot*, *gefahr*, *schutzgebiet*, kein zutritt,
        nicht betreten, nicht uberfliegen, hindernis*, *ausschluss*, tabu*, interdi*, defense d entrer,
        ne pas survoler, ne pas entrer, dangereu*, exclu, exclue*, reglementee*, prohibe*, prohibi*, restring*,
        restriccion*, peligr*, vedad*, no volar, no entrar, no pasar, no sobrevolar, obstacul*, vietat*, divieto,
        divieti, proibit*, interdett*, pericol*, esclus*, non entrare, non sorvolare, ostacol*, proibi*, restrit*,
        restrica*, perig*, excluid*, nao voar, nao entrar, *verbod*, *gevaar*, geen toegang, niet betreden,
        uitgesloten, obstakel*, afgesloten*, verboden, zakaz*, zabron*, wzbron*, niebezpiecz*, zamkniet*, wylaczon*,
        ograniczon*, przeszkod*, nebezpec*, vyloucen*, omezen*, prekazk*, uzavren*, bezletov*, *forbud*, *forbjud*,
        *forbudt*, *farezon*, *faresone*, *farligt*, farlig*, fara, fare, ingen adgang, adgang forbudt, avsparr*,
        *sparrat*, *sperret*, avstengt*, stengt*, avlyst*, hinder, hindring*, forhindring*, *restriksjon*,
        *restriktion*, ikke flyv*, ikke fly, *yasak*, tehlike*, girilmez*, ucusa kapali, kapali*, engel, engeller,
        kisitl*, *запрет*, *запрещ*, бесполет*, опасн*, закрыт*, ограничен*, препятств*, не входить, не летать,
        *заборон*, небезпе*, закрит*, безполь*, обмежен*, перешкод*, απαγορε*, κινδυν*, επικινδυν*, κλειστ*,
        περιορισμ*, εμποδι*, *απαγορε*, *محظور*, *ممنوع*, *حظر*, *خطر*, *مغلق*, *عائق*, *عوائق*, *مقيد*, محدود,
        *ورود ممنوع*, *موانع*, *بسته*, *אסור*, *סכנה*, *סגור*, *מוגבל*, *מכשול*, אין כניסה, *מסוכן*, *प्रतिबंध*,
        *निषिद्ध*, *वर्जित*, *खतर*, *निषेध*, *बाधा*, *禁飞*, *禁飛*, *禁止*, *禁区*, *禁區*, *禁入*, *勿入*, *危险*,
        *危險*, *限制*, *限飞*, *限飛*, *障碍*, *障礙*, *封闭*, *封閉*, *避让*, *立入*, *立ち入*, *危険*, *制限*,
        *障害*, *進入禁*, *금지*, *위험*, *제한*, *장애물*, *통제*, *출입금*
    """,
    BOUNDARY: """
        boundary, boundaries, perimeter*, border, borders, outline*, inclusion*, operation area*, operations area*,
        operational area*, operating area*, area of operation*, areas of operation*, operation zone*,
        operations zone*, operating zone*, operational zone*, mission area*, flight area*, flight zone*, work area*,
        working area*, keep in, keepin, stay in, site limit*, property line*, *grenze*, *begrenzung*, *umgrenzung*,
        einsatzgebiet*, einsatzraum*, einsatzbereich*, operationsgebiet*, betriebsgelande*, flugbereich*,
        fluggebiet*, flugraum*, arbeitsbereich*, umring*, limite*, perimetre*, frontiere*, zone d operation*,
        zone operationnelle, zone de vol, zone de travail, zone d intervention, aire d operation*, emprise,
        perimetr*, frontera*, area de operac*, zona de operac*, zona operativ*, zona de vuelo, zona de trabajo,
        lindero*, confin*, limiti, area operativ*, area di operaz*, zona di operaz*, zona di volo, area di lavoro,
        fronteira*, area de voo, zona de voo, area de trabalho, zona operac*, grens, grenzen, *begrenzing*,
        operatiegebied*, werkgebied*, inzetgebied*, vlieggebied*, omtrek, granic*, obwod*, perymetr*, obszar operac*,
        obszar dzialan*, strefa operac*, rejon dzialan*, obszar roboczy, rejon operac*, hranic*, obvod*,
        operacni oblast*, oblast operac*, operacni prostor*, pracovni oblast*, *grense*, *grans*, *graense*,
        *operasjonsomrad*, *operationsomrad*, *arbeidsomrad*, *arbetsomrad*, *arbejdsomrad*, *innsatsomrad*,
        *insatsomrad*, *indsatsomrad*, *operationsomraad*, sinir*, operasyon alan*, operasyon bolge*, calisma alan*,
        harekat alan*, gorev alan*, ucus alan*, границ*, периметр*, район операц*, зона операц*, район работ*,
        зона работ*, рабочая зона, район полет*, зона полет*, район действ*, межа, межи, меж, кордон*, район дій,
        робоча зона, район робіт, зона робіт, ορια, οριο, περιμετρ*, περιοχη επιχειρ*, ζωνη επιχειρ*, συνορ*, *حدود*,
        *محيط*, *منطقة العمليات*, *منطقة عمليات*, *منطقة العمل*, *مرز*, *محدوده عملیات*, *منطقه عملیات*,
        *محدوده کار*, *גבול*, *היקף*, *אזור פעולה*, *שטח פעולה*, *אזור מבצע*, *אזור הפעולה*, *सीमा*, *परिधि*,
        *संचालन क्षेत्र*, *कार्य क्षेत्र*, *边界*, *邊界*, *作业区*, *作業區*, *作业范围*, *任务区*, *任務區*,
        *行动区*, *行動區*, *周界*, *作战区*, *作戰區*, *境界*, *作業区*, *運用区*, *活動区*, *作戦区*, *外周*,
        *飛行区域*, *경계*, *작전 구역*, *작전구역*, *작업 구역*, *작업구역*, *운용 구역*, *운용구역*, *작전 지역*
    """,
    SURVEY: """
        coverage, search*, sector*, sweep*, aoi, aois, area of interest, areas of interest, region of interest,
        mapping*, scan, scans, scanning, inspection area*, inspection zone*, photogrammetry, orthophoto*,
        *suchgebiet*, *suchsektor*, *suchbereich*, *suchabschnitt*, *sektor*, absuch*, befliegung*, kartier*,
        erkund*, secteur*, balayage*, releve, releves, cartograph*, zone d interet, ratissage*, quadrillage*,
        prospection*, busqueda*, barrido*, rastreo*, rastrillaje*, levantamiento*, cartograf*, mapeo*,
        area de interes*, zona de interes*, prospeccion*, settor*, riliev*, mappatura*, perlustra*,
        area di interesse, busca, buscas, setor*, varredura*, levantamento*, mapeamento*, zoek*, *zoekgebied*,
        kartering*, opmeting*, interessegebied*, poszukiw*, przeszuk*, pomiar*, mapowan*, obszar zainteresowan*,
        patrac*, patran*, hledan*, prohledav*, mapovan*, pruzkum*, *sokomrad*, sokeomrad*, *sokeomrad*, sok, soket,
        sokning*, *sogeomrad*, sog, sogning*, eftersog*, leteaksjon*, leteomrad*, *kartlegg*, *kartlagg*, *kortlaeg*,
        oppmaling*, inmatning*, arama*, tarama*, haritala*, kesif*, поиск*, сектор*, прочес*, съемк*, обследован*,
        картограф*, разведк*, пошук*, обстежен*, зйомк*, розвідк*, αναζητησ*, τομεα*, τομεις, χαρτογραφ*, σαρωσ*,
        *قطاع*, *مسح*, *جستجو*, *نقشه برداری*, *سکتور*, *חיפוש*, *גזרה*, *גזרת*, *סריק*, *סקר*, *מיפוי*, *खोज*,
        *सेक्टर*, *सर्वेक्षण*, *तलाश*, *搜索*, *搜寻*, *搜尋*, *搜救*, *扇区*, *扇區*, *测绘*, *測繪*, *测区*,
        *航测*, *航測*, *调查*, *調查*, *扫描*, *掃描*, *捜索*, *探索*, *セクター*, *測量*, *調査*, *수색*, *탐색*,
        *섹터*, *측량*, *조사*, survey, surveys, surveying, such, suche, suchen, suchgebiet*, suchflach*, suchzone*,
        suchraum*, suchbereich*, sucheinsatz*, suchauftrag*, suchstreifen*, vermessung, vermessungsgebiet*,
        vermessungsflach*, vermessungsbereich*, zone de recherche*, zones de recherche*, aire de recherche*,
        recherches, area di ricerca*, aree di ricerca*, zona di ricerca*, zone di ricerca*, ricerca dispersi,
        περιοχη ερευν*, περιοχες ερευν*, ζωνη ερευν*, *منطقة البحث*, *منطقة بحث*, *مناطق البحث*, *عملية البحث*
    """,
    OBSTACLE: """
        building*, hall, halls, house, houses, shed, sheds, barn, barns, warehouse*, hangar*, silo*, garage*, roof,
        roofs, wall, walls, fence, fences, halle, hallen, *lagerhalle*, haus, hauser, scheune*, gebaude*, mauer*,
        batiment*, edifici*, gebouw*, budyn*, budov*, bygning*, byggnad*, bina, binalar, здани*, будівл*, κτιρι*,
        *مبنى*, *مباني*, *ساختمان*, *בניין*, *मकान*, *इमारत*, *建筑*, *建築*, *建物*, *건물*
    """,
    FENCE: "geofence*, geozone*",
    TASK: """
        task, tasks, job, jobs, waypoint*, way point*, poi, pois, point of interest, points of interest, goal, goals,
        target, targets, aufgabe*, auftrag*, wegpunkt*, zielpunkt*, tache, taches, point d interet, points d interet,
        tarea*, punto de interes, puntos de interes, compito, compiti, punti di interesse, taref*,
        pontos de interesse, taak, taken, zadania, zadanie, ukol*, oppgave*, uppgift*, opgave*, gorev, gorevler,
        задач*, задани*, завдан*, εργασι*, *مهمة*, *مهام*, *وظیف*, *משימ*, *कार्य सूची*, *任务点*, *任務點*,
        *任务列表*, *タスク*, *작업 목록*
    """,
    ROBOT: """
        robot, robots, vehicle, vehicles, fleet, roboter*, fahrzeug*, flotte*, vehicule*, robota, roboty, robotow,
        flota, vehiculo*, veicol*, flotta, veiculo*, frota, voertuig*, vloot, pojazd*, vozidl*, kjoretoy*, koretoj*,
        fordon*, robotlar, arac, araclar, filo, робот*, транспортн*, флот, ρομποτ*, οχηματα, *روبوت*, *ربات*,
        *רובוט*, *रोबोट*, *机器人*, *機器人*, *ロボット*, *로봇*
    """,
    STATION: """
        station, stations, dock, docks, charger, chargers, charging, ladestation*, ladesaule*, dockingstation*
    """,
    LANE: "lane, lanes, road, roads, path, paths, way, ways, corridor*, aisle*, track, tracks",
    HOME: """
        rally point*, rally, landing site*, landing zone*, landing pad*, landing area*, landing spot*,
        landing point*, landing place*, landing strip*, emergency landing, take off*, takeoff*, launch site*,
        launch point*, launch pad*, launch area*, home point*, home position*, home location*, helipad*, heliport*,
        lz, rtl point, *landeplatz*, *landepunkt*, startplatz*, startpunkt*, sammelpunkt*, notlande*, atterrissage*,
        decollage*, ralliement, aterrizaje*, despegue*, punto de reunion, atterraggio, decollo, punto di raccolta,
        pouso, decolagem, aterragem, landingsplaats*, opstijgplaats*, ladowisk*, startowisk*, miejsce ladowania,
        pristavac*, vzletov*, landingsplass*, landingsplats*, landingsplads*, inis alani, kalkis alani, inis noktasi,
        посадочн*, взлетн*, посадка, посадков*, злітн*, προσγειωσ*, απογειωσ*, *هبوط*, *اقلاع*, *فرود*, *נחיתה*,
        *המראה*, *हेलीपैड*, *लैंडिंग*, *降落*, *起飞*, *起飛*, *着陆*, *返航点*, *着陸*, *離陸*, *착륙*, *이륙*
    """,
    AIR: """
        air, aerial, airborne, aircraft, airplane*, aeroplane*, plane, planes, fixed wing, fixedwing, glider*,
        blimp*, airship*, flying, flyer, flyers, drone, drones, uav, uavs, uas, suas, ucav, rpas, rpa, quad, quads,
        quadrotor*, multirotor*, hexarotor*, octorotor*, tricopter*, *copter*, *kopter*, vtol, evtol, mavic*,
        matrice*, phantom, anafi*, skydio*, autel*, dji, wingtra*, ebee*, crazyflie*, tello*, agras*, parrot,
        *drohne*, *flugroboter*, fluggerat*, flugzeug*, *luftfahrzeug*, fliegend*, aeronef*, avion, avions, aerien*,
        dron, dronu, drona, drony, dronow, dronem, dronum, droni, droner, dronen, dronene, dronerne, dronlar, vant,
        vants, aeronave*, aviones, aereo, aerea, aereos, aereas, multirrotor*, velivol*, aeromobil*, *cottero*,
        *cotteri*, sapr, aviao, avioes, vliegtuig*, *luchtvaartuig*, vliegend*, bsp, bsl, powietrzn*, wielowirnik*,
        samolot*, smiglow*, letoun*, letadl*, bezpilotn*, vzdusn*, *dronare*, dronarna, luftfartoy*, luftfartoj*,
        luftfarkost*, *drone, *drones, iha, ihalar, siha, insansiz hava*, hava arac*, ucak*, ucan, дрон*, бпла, бла,
        бвс, беспилотник*, *коптер*, мультиротор*, самолет*, вертолет*, воздушн*, летательн*, безпілотник*, літак*,
        вертол*, повітрян*, аеродрон*, ντρον*, ντροουν*, bezzalogowiec, bezzalogowce, e bee, octo, heli, helis, δρον,
        δρονος, αεροσκαφ*, *κοπτερ*, εναερι*, σμηεα, σμη ε α, *طائر*, *درون*, *پهپاد*, *پهباد*, *کوپتر*, *هواپیما*,
        *هلیکوپتر*, *רחפנ*, *רחפן*, כטב*, מל ט, מל טים, *מטוס*, *מסוק*, *דרון*, *דרונ*, *ड्रोन*, *विमान*, *यूएवी*,
        *कॉप्टर*, *हवाई*, *无人机*, *無人機*, *飞机*, *飛機*, *旋翼*, *直升机*, *直升機*, *飞行器*, *飛行器*, *航拍*,
        *無人航空*, *ドローン*, *コプター*, *飛行機*, *드론*, *무인기*, *콥터*, *항공기*, *비행기*, *무인 항공*
    """,
    GROUND: """
        ground, wheeled, rover, rovers, ugv, ugvs, agv, agvs, amr, amrs, truck, trucks, lorry, lorries, vans, car,
        cars, buggy, forklift*, tractor, tractors, crawler*, quadruped*, legged, robot dog*, robodog*, turtlebot*,
        husky, jackal, mower*, atv, differential drive*, *rasenmaher*, *bodenroboter*, mahroboter*, *bodenfahrzeug*,
        lkw, pkw, *stapler, traktor*, laufroboter*, raupe, terrestre*, camion*, tracteur*, carretilla*, coche,
        coches, terrestr*, carrell*, muletto, trattor*, caminhao, caminhoes, empilhadeira*, vrachtwagen*, *heftruck*,
        grondrobot*, grondvoertuig*, ciezarowk*, wozek*, wozki, lazik*, ladowy, ladowe, pozemn*, vozik*, nakladni,
        *lastbil*, gaffeltruck*, bil, biler, bilar, markfordon*, bakkekjoretoy*, kara arac*, ika, kamyon*, ровер*,
        наземн*, грузовик*, погрузчик*, автомобил*, вездеход*, вантажівк*, навантажувач*, автомобіл*, επιγει*,
        φορτηγ*, *شاحنة*, *شاحنات*, *أرضي*, *کامیون*, *زمینی*, *لیفتراک*, *خودرو*, *משאית*, *משאיות*, *קרקעי*,
        *מלגז*, *רובר*, *ट्रक*, *रोवर*, *无人车*, *無人車*, *小车*, *卡车*, *卡車*, *叉车*, *地面*, *车辆*, *車両*,
        *トラック*, *ローバー*, *フォークリフト*, *地上*, *로버*, *트럭*, *지게차*, *지상*, delivery van
    """,
}

_CAMEL = re.compile(r"(?<=[a-z])(?=[A-Z])")
_SHORT_FOR = {"ao": BOUNDARY, "roi": SURVEY}
_SHORT = re.compile(r"(?<![^\W_])(?:AO|ROI)(?![^\W_])")
"""Area of operation, region of interest: in capitals, or alone; other languages have words of these letters."""
_ASCII_WORD = re.compile("[a-z]+")
_PLAIN = str.maketrans({"ł": "l", "ø": "o", "đ": "d", "ı": "i", "æ": "ae", "œ": "oe", "ð": "d", "þ": "th"})


@lru_cache(maxsize=1024)
def plain(text: str) -> str:
    """Return the words of a text: in lower case, without accents, marks and digits, a space around each."""
    if text.isascii():
        return f" {' '.join(_ASCII_WORD.findall(_CAMEL.sub(' ', text).lower()))} "
    folded = unicodedata.normalize("NFKD", _CAMEL.sub(" ", text).casefold().translate(_PLAIN))
    kept = "".join(" " if _divides(c) else c for c in folded if unicodedata.category(c) not in ("Mn", "Cf"))
    return f" {' '.join(unicodedata.normalize('NFC', kept).split())} "


def _divides(character: str) -> bool:
    return unicodedata.category(character)[0] != "L" and unicodedata.category(character) != "Mc"


def _expression(patterns: str) -> re.Pattern[str]:
    parts = []
    for pattern in dict.fromkeys(one.strip() for one in patterns.split(",")):
        begins, ends = pattern.startswith("*"), pattern.endswith("*")
        parts.append(("" if begins else " ") + re.escape(plain(pattern).strip()) + ("" if ends else "(?= )"))
    return re.compile("|".join(parts))


@lru_cache(maxsize=1)
def _expressions() -> Mapping[str, re.Pattern[str]]:
    return {meaning: _expression(patterns) for meaning, patterns in _PATTERNS.items()}


def meanings(text: str) -> Mapping[str, str]:
    """Return what the words of a text say, each meaning with the first word that has it."""
    found = _meanings(plain(text))
    short = _SHORT.search(text)
    if short is None and plain(text).strip() not in _SHORT_FOR:
        return found
    word = plain(text).strip() if short is None else short[0]
    return {_SHORT_FOR[word.casefold()]: word} | dict(found)


@lru_cache(maxsize=4096)
def _meanings(words: str) -> Mapping[str, str]:
    """Names of many features differ by their numbers alone, so that most are looked up once."""
    found = {meaning: match for meaning, one in _expressions().items() if (match := one.search(words))}
    return {meaning: match[0].strip() for meaning, match in found.items()}


def moves(text: str) -> str | None:
    """Return `air` or `ground` where the words of a text say one of the two, and not both."""
    said = [meaning for meaning in (AIR, GROUND) if meaning in meanings(text)]
    return said[0] if len(said) == 1 else None


def is_only(text: str, *wanted: str) -> bool:
    """Return whether a text has no words besides those of the wanted meanings, and single letters."""
    return not meanings(text).keys().isdisjoint(wanted) and _is_only(plain(text), wanted)


def _is_only(words: str, wanted: tuple[str, ...]) -> bool:
    for meaning in wanted:
        words = _expressions()[meaning].sub(" ", words)
    return all(len(word) < 2 for word in words.split())
